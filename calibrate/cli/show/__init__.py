"""What commands show: results, progress, and that something goes on."""
