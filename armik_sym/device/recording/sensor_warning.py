"""What can be odd about the counts of a sensor."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum


class WarningKind(Enum):
    """What is odd; the value is the one in a recording.

    STUCK: not one count of change for 5 s while another sensor moved. JUMP: a step between two samples no arm
    can make. OUT_OF_RANGE: a count the converter cannot give. AT_END: a potentiometer at the very end of its
    scale, as with a broken wire, or in the gap between its ends.
    """

    STUCK = 0
    JUMP = 1
    OUT_OF_RANGE = 2
    AT_END = 3


_WORDS = {
    WarningKind.STUCK: "is still to the count for {value:.1f} s while another sensor moved: is it stuck?",
    WarningKind.JUMP: "jumped by {value:g} counts between two samples: a loose contact, or a blow?",
    WarningKind.OUT_OF_RANGE: "gives {value:g} counts, outside its scale: is the firmware's span right?",
    WarningKind.AT_END: "gives {value:g} counts, an end of its scale: a broken wire, or turned too far?",
}


@dataclass(frozen=True, slots=True)
class SensorWarning:
    """Something odd in the counts of one channel; the samples themselves are kept as they are.

    Attributes:
        kind: What is odd.
        channel: Which channel, from 0.
        sequence: Number the device gave the sample it was seen in, modulo 2^32.
        value: The count or step, in [count]; of STUCK the time, in [s].
        times: How many samples since the warning before of this kind and channel, this one included.
    """

    kind: WarningKind
    channel: int
    sequence: int
    value: float = math.nan
    times: int = 1

    def __str__(self) -> str:
        often = f" ({self.times} samples)" if self.times > 1 else ""
        return f"channel {self.channel} {_WORDS[self.kind].format(value=self.value)}{often}"
