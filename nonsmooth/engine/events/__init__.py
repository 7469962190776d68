"""The automaton: flow, guard, jump, new modes, and the record of what happened."""
