"""The worst value of each check, and its place."""

from dataclasses import dataclass


@dataclass
class Finding:
    check: str
    unit: str
    limit: float  # None: for information only
    worst: float = None  # None: nothing was looked at
    segment: int = -1
    phase: int = -1
    action: str = ""
    time: float = 0.0
    what: str = ""

    @property
    def failed(self):
        return self.limit is not None and self.worst is not None and not self.worst <= self.limit

    @property
    def where(self):
        if self.worst is None:
            return ""
        where = f"segment {self.segment} ({self.action}), phase {self.phase}, {self.time:.4f} s"
        return f"{where}, {self.what}" if self.what else where


class Findings:
    """Checks are listed in the order in which they were declared."""

    def __init__(self):
        self.all = {}

    def declare(self, check, unit, limit):
        self.all[check] = Finding(check, unit, limit)

    def note(self, check, value, phase, time, what=""):
        """`what` may be a function without arguments. NaN counts as the worst value."""
        finding = self.all[check]
        if finding.worst is not None and (finding.worst != finding.worst or value <= finding.worst):
            return
        finding.worst, finding.time = float(value), float(time)
        finding.segment, finding.phase = phase.segment, phase.index
        finding.action = phase.action
        finding.what = what() if callable(what) else what

    def note_largest(self, check, values, phase, time, names):
        """The largest of `values`, with its entry of `names`."""
        if len(values):
            i = int(values.argmax())
            self.note(check, values[i], phase, time, lambda: str(names[i]))

    @property
    def accepted(self):
        return not any(finding.failed for finding in self.all.values())

    def most_failed(self):
        failed = [finding for finding in self.all.values() if finding.failed]
        return max(failed, key=lambda finding: finding.worst / finding.limit)
