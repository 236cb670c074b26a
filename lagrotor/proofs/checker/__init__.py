"""The checker verifies certificates with its own arithmetic; other packages import only `check` from it."""
