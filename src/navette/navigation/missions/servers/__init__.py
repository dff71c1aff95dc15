"""Nav2's navigation actions."""
