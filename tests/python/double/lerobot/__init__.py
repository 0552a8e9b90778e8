"""A double of what lerobot_teleoperator_palpate needs of LeRobot, which Debian does not package."""
