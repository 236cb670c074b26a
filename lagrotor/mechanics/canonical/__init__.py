"""The Hamiltonian side: brackets, canonical transformations, normal forms."""
