"""The paper of the rotor pair: its catalogue, its record, its premises, the tests of its claims."""
