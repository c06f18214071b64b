"""What stands for a value that is not there."""


class ExecutionBlocker:
    def __init__(self, message):
        self.message = message
