"""What the questions share: from a study and its runs to emulators and one problem of inference."""
