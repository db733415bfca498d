"""The one exception a user of the modelling layer meets."""


class ModelError(ValueError):
    """A model that cannot be compiled as it stands.

    The message is one sentence: what was written, what was found, what to do.
    """
