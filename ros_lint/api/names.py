"""Functions about names: find similar names, and suggest them in messages."""

from ros_lint.base.suggestions import ask_if_meant, did_you_mean, nearest_names, of_same_kind, shorten_list, similar_names
from ros_lint.collectors.interfaces import naming as interfaces
from ros_lint.knowledge.spelling import VENDOR, may_be_package, near_names

__all__ = [
    "VENDOR",
    "ask_if_meant",
    "did_you_mean",
    "interfaces",
    "may_be_package",
    "near_names",
    "nearest_names",
    "of_same_kind",
    "shorten_list",
    "similar_names",
]
