"""The commands of ros-lint, beside the check: questions to the same model."""
