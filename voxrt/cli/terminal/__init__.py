"""What people see: messages, progress, errors."""
