"""What differential evolution is made of: the search, the slack of equalities, the polish."""
