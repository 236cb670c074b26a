"""The second program: it verifies certificates and shares no arithmetic with the search; only `check` is taken from it."""
