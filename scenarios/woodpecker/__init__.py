"""The woodpecker toy: a bird on a sleeve that pecks its way down a pole."""
