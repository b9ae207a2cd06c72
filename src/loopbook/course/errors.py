"""What goes wrong with a sheet, an answer, a course; each says where and what to do."""

from derivations.errors import LoopbookError


class SheetError(LoopbookError):
    """A sheet cannot be used as its author wrote it."""


class Redraw(LoopbookError):
    """These numbers make no good exercise; others are drawn. reason: in the author's words."""

    def __init__(self, reason: str):
        self.reason = reason
        super().__init__(f"these numbers make no exercise: {reason}")


class Unreadable(LoopbookError):
    """A student's answer is not of the kind that was asked for; the message is for the student."""


class CourseError(LoopbookError):
    """A roster, a manifest, a folder of submissions is not usable; the message is for the teacher."""
