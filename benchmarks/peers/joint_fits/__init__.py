"""Joint fits of planted data: two materials on one wall, one material on two walls."""
