"""What runs cases elsewhere than in processes of this machine, behind one interface."""
