"""The size effect: windows of one joint, how its mechanics goes with size, and eq. 6."""
