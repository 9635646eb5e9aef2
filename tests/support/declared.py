"""Settings that say when a key is read which their function does not declare."""


class Declared(dict):
    """A mapping that refuses keys it does not have, even to `get`, and remembers which were read.

    Mappings within it are such mappings, too, whose keys are remembered behind a point.
    """

    def __init__(self, settings, seen=None, before=""):
        self.seen, self._before = set() if seen is None else seen, before
        super().__init__(
            {
                key: Declared(value, self.seen, f"{before}{key}.")
                if isinstance(value, dict) and key == "material"
                else value
                for key, value in settings.items()
            }
        )

    def __getitem__(self, key):
        """Value of a key, which is remembered."""
        assert dict.__contains__(self, key), f"not declared in study/stages.py: {self._before}{key}"
        self.seen.add(f"{self._before}{key}")
        return super().__getitem__(key)

    def get(self, key, default=None):
        """As a mapping has it, but a key that is not there is an error."""
        return self[key]

    def __contains__(self, key):
        self[key]
        return True
