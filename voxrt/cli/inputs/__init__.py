"""What commands look at: memories, assets, configurations of the hardware."""
