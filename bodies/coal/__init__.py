"""coal, a fork of FCL with tolerances that can be set, as another library for the same; needs nonsmooth[coal]."""
