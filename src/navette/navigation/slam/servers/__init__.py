"""Services of the SLAM node."""
