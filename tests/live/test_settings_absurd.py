"""Whatever stands in a settings file: it is accepted and the twin runs, or one line and exit code 5 or 1;
never another exception."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.thorough import one_of
from twin.errors import SettingsError, TwinError
from twin.live.keelson.endpoint import check
from twin.live.keelson.zenoh_config import BusSettings, configuration
from twin.live.service import opened
from twin.live.signals import config
from twin.live.signals.config import Settings
from twin.live.signals.keys import KEYS

ABSURD = {
    "400 digits": "1" + "0" * 400,
    "minus 400 digits": "-" + "9" * 400,
    "5000 digits": "7" * 5000,
    "inf": "inf",
    "nan": "nan",
    "1e999": "1e999",
    "hex": "0xffffffffffffffffffffff",
    "a date": "2026-11-25T00:00:00Z",
    "a table": "{a = 1}",
    "an empty list": "[]",
    "an empty text": '""',
    "a long list": "[" + "1.0, " * 3000 + "1.0]",
    "deep brackets": "[" * 3000 + "]" * 3000,
    "many lines": '"""a\nb\nc"""',
    "a zero byte": '"a\\u0000b"',
    "a long text": '"' + "x" * 100_000 + '"',
    "a folder": '"/"',
    "a device without end": '"/dev/zero"',
    "a device": '"/dev/null"',
    "texts": '["", "x"]',
    "not a place": '"nonsense"',
    "no port": '"tcp/127.0.0.1"',
    "port 99999": '"tcp/127.0.0.1:99999"',
    "lists in lists": "[[1.0], [2.0]]",
}
QUIET = {
    "bus.listen": "tcp/127.0.0.1:0",
    "loop.priority": 0,
    "loop.lock_memory": False,
    "log.folder": "",
    "adaptation.on": False,
}


def accepted(tmp_path, text):
    """The settings of this text, or None when they were refused in one line."""
    path = tmp_path / "twin.toml"
    path.write_text(text)
    try:
        return config.load(path)
    except SettingsError as error:
        assert error.exit_code == 5 and "\n" not in str(error) and len(str(error)) < 900, error
        return None


@pytest.mark.parametrize("key", KEYS, ids=lambda key: key.name)
@pytest.mark.parametrize("name", ABSURD)
def test_F1_every_key_with_every_absurd_value_is_a_setting_or_one_line(tmp_path, key, name):
    section, _, word = key.name.partition(".")
    accepted(tmp_path, f"[{section}]\n{word} = {ABSURD[name]}\n")


@given(st.binary(max_size=300) | st.text(max_size=200).map(lambda t: t.encode(errors="replace")))
@settings(max_examples=200)
def test_F2_bytes_of_any_kind_are_settings_or_one_line(tmp_path_factory, data):
    path = tmp_path_factory.mktemp("any") / "twin.toml"
    path.write_bytes(data)
    try:
        config.load(path)
    except SettingsError as error:
        assert "\n" not in str(error)


def test_F2_a_file_without_end_is_no_settings():
    with pytest.raises(SettingsError, match="cannot be settings"):
        config.load("/dev/zero")


TEXTS = [key.name for key in KEYS if key.kind is str]
STRANGE = (
    "/",
    "/dev/null",
    "/dev/zero",
    "nowhere/x",
    "é" * 300,
    "x" * 4000,
    "..",
    "/proc/self/mem",
    "a b",
    "tcp/127.0.0.1:99999",
    "tcp/[::1]:0",
    "'",
)


@pytest.mark.parametrize("name", one_of(TEXTS, 5))
def test_F1_the_service_opens_with_any_text_or_says_in_one_line_why_not(name, tmp_path, monkeypatch):
    """Test: every setting that is a text, with texts that are no such thing. Expected: it ticks, or a
    TwinError of one line."""
    monkeypatch.chdir(tmp_path)
    for text in STRANGE if name != "observer.certificate" else STRANGE[:2]:
        chosen = Settings(QUIET | {"state.folder": str(tmp_path / "state")}).but(name, text)
        try:
            with opened(chosen) as service:
                service.loop.tick(service.clock.wait())
        except TwinError as error:
            assert "\n" not in str(error) and len(str(error)) < 900, (text, error)


def test_F1_the_bus_listens_and_connects_only_where_that_is_possible():
    for good in (
        "tcp/127.0.0.1:7447",
        "tcp/[::1]:0",
        "tls/twin.local:7447",
        "udp/10.0.0.5:1#iface=eth0",
        "unixsock-stream/run/z",
    ):
        assert check(good, "listen") == good
    for bad in (
        "",
        "tcp/",
        "tcp/127.0.0.1",
        "tcp/127.0.0.1:99999",
        "tcp/127.0.0.1:abc",
        "tcp/:7447",
        "foo/127.0.0.1:1",
        "tcp/a b:1",
        "tcp/127.0.0.1:1\n",
        "tcp/127.0.0.1:1?rel=9",
        "tcp/" + "x" * 300 + ":1",
        "serial/dev/tty",
        "tcp/127.0.0.1:１",
    ):
        for settings_ in (BusSettings(router=bad), BusSettings(connect=(bad,)), BusSettings(listen=bad)):
            if bad or settings_.connect:
                with pytest.raises(SettingsError, match="bus"):
                    configuration(settings_)


@pytest.mark.parametrize("field", ["listen", "router", "connect"])
@given(
    place=st.text(max_size=40)
    | st.from_regex(r"(tcp|udp)/[a-z0-9.\[\]:]{0,20}:[0-9]{0,7}[?#]?[a-z0-9=]{0,8}", fullmatch=True)
)
@settings(max_examples=150)
def test_F1_no_place_at_all_makes_zenoh_panic(field, place):
    places = {"listen": "", "router": "", "connect": ()} | {field: (place,) if field == "connect" else place}
    try:
        configuration(BusSettings(**places))
    except SettingsError as error:
        assert "\n" not in str(error)
