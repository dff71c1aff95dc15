"""Which samples a subscription wants."""

from navette.runtime.content_filter import ContentFilterOptions

__all__ = [
    "ContentFilterOptions",
]
