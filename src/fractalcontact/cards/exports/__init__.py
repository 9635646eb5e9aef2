"""Constants of a card for other codes: one module a code, each with ``text_of`` and ``ENDING``."""
