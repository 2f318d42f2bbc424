"""What is filmed, and how: settings, the file they are written in, kinds of camera and passes."""
