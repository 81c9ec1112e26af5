"""What every result can do: be read as JSON, as a table, as a line, as a page."""

import copy
import logging
import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Self

from twin import whole
from twin.num import num
from twin.recording.progress import Progress

if TYPE_CHECKING:
    import pandas

PathLike = str | os.PathLike[str]
LOG = logging.getLogger("twin")


def quietly(progress: Progress | None) -> Progress:
    """The owner's hook for progress, or the logger `twin` at level INFO."""
    return progress or LOG.info


def frame(rows: Any) -> "pandas.DataFrame":
    """A table of `rows` (a list of flat or nested dictionaries); nested keys are joined by a dot.

    ImportError in one line where pandas is not installed.
    """
    try:
        import pandas
    except ImportError:
        raise ImportError("pandas is needed for a DataFrame. Run: pip install 'shiptwin[notebook]'") from None
    return pandas.json_normalize(list(rows))


@dataclass(frozen=True, repr=False)
class Result:
    """Base of all results. `data`: the documented JSON of the verb (docs/json.md), plain types only."""

    data: Mapping[str, Any] = field(kw_only=True)

    def to_dict(self) -> dict[str, Any]:
        """The documented JSON, a copy of its own."""
        return copy.deepcopy(dict(self.data))

    def with_keys(self, **keys: Any) -> Self:
        """The same result with further keys in its JSON and on its page, such as the command that was
        typed."""
        return replace(self, data={**self.data, **keys})

    def text(self) -> list[str]:
        """The lines that its verb prints; one line where there is no such verb."""
        return [repr(self)]

    def write_page(self, path: PathLike) -> None:
        """The page as a file, whole or not at all; TwinError where it cannot be written."""
        whole.write(path, self.page(), "--report")

    def to_dataframe(self) -> "pandas.DataFrame":
        """The result's main table, one row an item; which one it is, the class says."""
        return frame(self._rows())

    def _rows(self) -> Any:
        raise NotImplementedError  # every final class says what its rows are

    def _repr_html_(self) -> str:
        """The page, for a notebook's cell: in a frame of its own, as its styles and scripts are."""
        import html

        page = html.escape(self.page(), quote=True)
        style = "width:100%;height:720px;border:0"
        return f'<iframe srcdoc="{page}" style="{style}" title="{html.escape(repr(self))}"></iframe>'

    def page(self) -> str:
        """One self-contained HTML page."""
        raise NotImplementedError


def metres(value: float | None) -> str:
    """A length [m] with as many digits as are known."""
    return "?" if value is None else f"{num(value, 3)} m"
