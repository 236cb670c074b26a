"""The paper of the rotor pair: catalogue, record, premises and tests of claims."""
