"""Features of a clip, on which layers work part by part, so that few of their results are in memory at once.

Layers within pictures take a few pictures at a time, one layer after another up to the next layer over time. Layers
over time mix the same place of all pictures, and their normalisation takes its statistics from the whole clip: they
take strips of all pictures, the statistics being gathered first. The result is that of the whole clip at once.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from torch import Tensor, nn
from torch.nn import functional

from .clip_statistics import ClipStatistics

__all__ = ["ClipFeatures", "TimeStack"]

PictureLayer = Callable[[Tensor], Tensor]
"""Acts on each of some pictures by itself, shapes [n, c, h, w] to [n, c', h', w']."""


class TimeStack(nn.Module):
    """What time adds to the features of a clip."""

    def __init__(self, first: nn.Sequential, second: nn.Sequential) -> None:
        super().__init__()
        self.in_layers, self.out_layers = first, second

    def forward(self, x: Tensor) -> Tensor:
        """x: features, shape [1, c, t, h, w]."""
        return self.out_layers(self.in_layers(x))

    def in_strips(self, strips: Sequence[Tensor]) -> Callable[[Tensor], Tensor]:
        """The same for one strip at a time.

        Args:
            strips: the whole clip, shape [1, c, t, rows, w] each; left as they are meanwhile.

        Returns:
            Gives what ``forward`` gives of the whole clip, at the place of one strip.
        """
        (norm_in, _, convolution_in), (norm_out, *_, convolution_out) = self.in_layers, self.out_layers
        assert isinstance(norm_in, nn.GroupNorm)
        assert isinstance(norm_out, nn.GroupNorm)
        given, between = ClipStatistics(norm_in), ClipStatistics(norm_out)
        for strip in strips:
            given.add(strip)

        def halfway(strip: Tensor) -> Tensor:
            return convolution_in(functional.silu(given.normalised(strip), inplace=True))

        for strip in strips:
            between.add(halfway(strip))
        return lambda strip: convolution_out(functional.silu(between.normalised(halfway(strip)), inplace=True))


class ClipFeatures:
    """The features of one clip."""

    def __init__(self, x: Tensor, budget: int | None = None) -> None:
        """Start from given features, which stay as they are.

        Args:
            x: shape [t, c, h, w].
            budget: about how many numbers a layer's result may hold, at least a picture's; None takes all at once.
        """
        self._x, self._given, self._budget = x, True, budget
        self._waiting: list[PictureLayer] = []

    def then(self, *layers: PictureLayer) -> None:
        """Apply layers within pictures, when the result is asked for."""
        self._waiting += layers

    def settled(self) -> Tensor:
        """The features after all layers, shape [t, c, h, w]; whoever changes them changes the clip."""
        if self._waiting:
            self._x, self._waiting, self._given = self._applied(self._waiting), [], False
        return self._x

    def add_over_time(self, stack: TimeStack, share: Tensor) -> None:
        """Add a share of what layers over time make of the clip."""
        clip = self.settled().transpose(0, 1)[None]
        strips = clip.split(self._rows(clip), dim=3)
        added = stack.in_strips(strips) if len(strips) > 1 else stack
        # Only now, as the statistics are those of the clip before.
        for strip in strips:
            strip += share * added(strip)

    def _applied(self, layers: Sequence[PictureLayer]) -> Tensor:
        x = self._x
        if self._budget is None or len(x) == 1:
            return _through(layers, x)[0]
        first, largest = _through(layers, x[:1])
        # Where sums are in single precision, what comes of them takes the room and the type of what was there.
        inside = not self._given and first.shape[1:] == x.shape[1:]
        out = x if inside else first.new_empty((len(x), *first.shape[1:]))
        out[:1] = first
        together = max(1, self._budget // largest)
        for start in range(1, len(x), together):
            part = slice(start, start + together)
            out[part] = _through(layers, x[part])[0]
        return out

    def _rows(self, clip: Tensor) -> int:
        """Rows of a strip."""
        rows = clip.shape[3]
        if self._budget is None:
            return rows
        return min(rows, max(1, self._budget * rows // clip.numel()))


def _through(layers: Sequence[PictureLayer], x: Tensor) -> tuple[Tensor, int]:
    """Pictures after some layers, and how many numbers the largest of all results holds."""
    largest = x.numel()
    for layer in layers:
        x = layer(x)
        largest = max(largest, x.numel())
    return x, largest
