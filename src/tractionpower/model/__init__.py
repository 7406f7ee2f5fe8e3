"""What the user describes: frozen declarations that compute nothing."""
