"""The workspace of the engine: a declaration for each number, the layout that follows from them, codes and tables."""
