"""Running any system: generated programs, integration, sections, Lyapunov exponents, pictures."""
