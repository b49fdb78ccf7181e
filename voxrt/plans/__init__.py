"""How a build is divided into tiles, and who runs them: this process, several, or a cluster."""
