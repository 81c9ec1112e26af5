"""Files that are there whole or not at all."""

import pytest

from twin import whole
from twin.errors import TwinError


def test_what_was_there_is_replaced_and_nothing_else_stays(tmp_path):
    (tmp_path / "x.toml").write_text("old")
    whole.write(tmp_path / "x.toml", "new\n")
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("x.toml", "new\n")]


@pytest.mark.parametrize("where", ["none/x.toml", "folder"])
def test_where_it_cannot_be_written_nothing_is_left_behind(tmp_path, where):
    """Test: a folder that is not there, and a folder in the file's own place. Expected: one line, exit code
    1."""
    (tmp_path / "folder").mkdir()
    with pytest.raises(TwinError, match=r"cannot be written .* --json") as failure:
        whole.write(tmp_path / where, "new\n", "--json")
    assert failure.value.exit_code == 1 and [p.name for p in tmp_path.iterdir()] == ["folder"]
