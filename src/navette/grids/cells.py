"""What the value of a cell means (nav_msgs/OccupancyGrid)."""

UNKNOWN = -1
FREE = 0
LETHAL = 100
