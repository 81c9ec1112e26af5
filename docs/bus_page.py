"""docs/bus.md and what is shipped for others, made of the twin's one table of subjects and messages:

    python docs/bus_page.py

writes docs/bus.md, and shiptwin.proto, shiptwin.desc and subjects.yaml beside the table."""

from importlib.resources import files
from pathlib import Path

import keelson

import twin.live.keelson
from twin.live.keelson import messages
from twin.live.keelson.meanings import meaning_of, unit_of
from twin.live.keelson.messages import TABLE
from twin.live.keelson.topics import ALIKE, FLOAT, INPUTS, OF_ACTUATORS, OUTPUTS, Output, Topic
from twin.live.keelson.zenoh_config import MAX_BYTES, BusSettings
from twin.live.signals.channels import BY_NAME
from twin.live.signals.readings import WORDS
from twin.physics.actuators.actuator_channels import CHANNELS_OF

DOCS = Path(__file__).resolve().parent
SHIPPED = Path(str(files(twin.live.keelson)))
FIRST = "// Made by docs/bus_page.py from the twin's table of messages.\n"
OTHER_UNITS = {
    "location_fix": "deg, WGS84",
    "twin_tick": "each field's own",
    "twin_status": "words",
    "configuration_json": "JSON",
}

HEAD = """# Bus and logs for others

Made by `python docs/bus_page.py` from the twin's table of subjects (`twin/live/keelson/topics.py`) and
messages (`messages.py`).

Keys are [Keelson](https://github.com/RISE-Maritime/keelson)'s, on [Zenoh](https://zenoh.io):

    {base}/@v0/{entity}/pubsub/{subject}/{source}

`base` and `entity` are settings (`twin` and `ship` without any). The `@` begins a chunk that no wildcard
matches: subscribe to `twin/@v0/ship/pubsub/**`, not to `twin/**`. Each message is a `core.Envelope`
(time, payload); the payload is protobuf of the type below. In a log (MCAP) the topic is the key and the
message is the payload without its envelope, with its schema. Angles are degrees, north is 0, to
starboard is positive; wind and waves come *from*, the current goes *towards*.
"""

SDK = """
## For Keelson's SDK and its viewers

The package ships `shiptwin.proto`, `shiptwin.desc` (a FileDescriptorSet) and `subjects.yaml` (the
subjects that Keelson does not know), so that the SDK decodes every message of the twin:

```python
from importlib.resources import files
import keelson

shipped = files("twin.live.keelson")
keelson.add_well_known_subjects_and_proto_definitions(shipped / "subjects.yaml", shipped / "shiptwin.desc")

subject = keelson.get_subject_from_pubsub_key("twin/@v0/ship/pubsub/twin_tick/twin")
received_at, enclosed_at, payload = keelson.uncover(envelope)
tick = keelson.decode_protobuf_payload_from_type_name(payload, keelson.get_subject_schema(subject))
```

`python -c "import importlib.resources as r; print(r.files('twin.live.keelson'))"` prints the folder;
programs in other languages compile `shiptwin.proto`.
"""

LOGS = """
## Logs

A log of the twin (`twin run`, `twin replay -o`) holds every input sample as it came and one
`shiptwin.Tick` a tick; an imported voyage holds `shiptwin.Row`. Every file that the twin writes says at
its head, as the MCAP metadata record `shiptwin.provenance`, what wrote it:

| name | what |
|---|---|
| `software`, `version` | shiptwin, and its version |
| `ship`, `ship_hash` | name, and a hash of every number of the ship and of the effects in the ship file |
| `ship_file` | as in the settings |
| `length_m`, `beam_m` | between perpendiculars, and beam |
| `settings` | all of them as JSON by key; of addresses only what stands in front of `?` and `#` |

An imported voyage says software and version there, and what is known about the measurements in
`shiptwin.voyage`; a file that a crash left open keeps its head when it is repaired. `twin fault -o`
keeps the words of the log that it copies.

```python
from mcap.reader import make_reader

with open("voyage.mcap", "rb") as stream:
    about = {m.name: m.metadata for m in make_reader(stream).iter_metadata()}["shiptwin.provenance"]
```
"""


def proto() -> str:
    """The messages as a file that a protobuf compiler reads."""
    blocks = [FIRST, 'syntax = "proto3";\n\npackage shiptwin;\n']
    for name, fields in TABLE.items():
        lines = [
            f"  {_kind(kind)} {field} = {number};  // {meaning_of(name, field)}"
            for number, (field, kind) in enumerate(fields, start=1)
        ]
        blocks.append("\n".join([f"message {name} {{", *lines, "}\n"]))
    return "\n".join(blocks)


def _kind(kind: str) -> str:
    word = {"?": "optional ", "*": "repeated "}.get(kind[-1], "")
    return word + kind.rstrip("?*")


def descriptors() -> bytes:
    """The same as a FileDescriptorSet."""
    return messages.schema_bytes("shiptwin.Tick")


def subjects() -> str:
    """The subjects that Keelson does not know, as its SDK reads them."""
    known = _keelsons()
    ours = {s.subject: s.type_name for s in (*INPUTS, *OUTPUTS) if s.subject not in known}
    ours |= dict.fromkeys(OF_ACTUATORS, FLOAT)
    lines = [f"{subject + ':':<40}{type_name}" for subject, type_name in ours.items()]
    head = "# Made by docs/bus_page.py: subjects of the twin that Keelson does not know."
    return "\n".join([head, *lines, ""])


def _keelsons() -> set[str]:
    """Keelson's well-known subjects, from its own file: what was added in this process does not count."""
    lines = (Path(keelson.__file__).parent / "subjects.yaml").read_text().splitlines()
    return {line.partition(":")[0] for line in lines if line[:1].isalpha()}


def page() -> str:
    """docs/bus.md."""
    blocks = [HEAD, _inputs(), _actuators(), _outputs(), SDK, _messages(), LOGS]
    return "".join(blocks)


def _inputs() -> str:
    rows = [_input(topic) for topic in INPUTS]
    return "\n".join(
        [
            "\n## In: what the twin listens to\n",
            "From any source but `twin` and `twin/...`; of each subject the newest "
            f"{BusSettings().depth} samples between two ticks are taken, and at most {MAX_BYTES} bytes a "
            "sample. A channel is lost when its newest",
            "sample is older than ten of its own periods, at the latest after the time in the last column. "
            "What is outside the range is refused.\n",
            "| subject | type | unit | range | what | lost after |",
            "|---|---|---|---|---|---|",
            *rows,
            "",
        ]
    )


def _actuators() -> str:
    rows = []
    for subject, last in OF_ACTUATORS.items():
        c = CHANNELS_OF[last]
        rows.append(f"| `{subject}/NAME` | {FLOAT} | {c.unit} | {c.low:g} .. {c.high:g} | {c.doc} |")
    also = " and ".join(f"`{subject}/NAME` fills `NAME.{last}`" for subject, last in ALIKE.items())
    return "\n".join(
        [
            "\n### Of a ship that lists its actuators\n",
            "Of a ship file with `[[actuators]]` (docs/actuators.md) the twin listens to each channel of "
            "each, too. The source id begins with the actuator's name as in the ship file,",
            "and may go on behind a slash: `actuator_rate_rpm/port` and `actuator_rate_rpm/port/encoder` "
            f"both fill `port.rate_rpm`. Keelson's own are heard as well: {also}.",
            "Names that the ship file does not have are refused. Lost after 5 s, or after ten of the "
            'channel\'s own periods. Under `[sources]` a channel stands in quotes: `"port.rate_rpm" = '
            '"port/encoder"`.\n',
            "| subject / source | type | unit | range | what |",
            "|---|---|---|---|---|",
            *rows,
            "",
        ]
    )


def _input(topic: Topic) -> str:
    channels = [BY_NAME[name] for name in topic.channels]
    low, high = channels[0].low / topic.factor, channels[0].high / topic.factor
    fix = topic.subject == "location_fix"
    span = "latitude, longitude" if fix else f"{low:g} .. {high:g}"
    doc = "position" if fix else channels[0].doc
    unit = OTHER_UNITS.get(topic.subject) or unit_of(topic.subject)
    return f"| `{topic.subject}` | {topic.type_name} | {unit} | {span} | {doc} | {channels[0].stale_s:g} s |"


def _outputs() -> str:
    rows = [_output(output) for output in OUTPUTS]
    return "\n".join(
        [
            "\n## Out: what the twin says\n",
            "| subject / source | type | unit | rate | what |",
            "|---|---|---|---|---|",
            *rows,
            "",
            "Predictions stand in `twin_tick` (`predictions`). `configuration_json` holds `software`, "
            "`version`, `ship`, `ship_hash`, `length_m`, `beam_m` and `origin`",
            "(`live`, or `replay` for `twin replay --to-bus`). Nothing that is not a finite number is ever "
            "said: such a field is absent.",
            "A liveliness token stands at `{base}/@v0/{entity}/pubsub/*/twin` as long as the twin is there.",
            "",
        ]
    )


def _output(output: Output) -> str:
    rate = f"{1.0 / output.every_s:g} Hz" if output.every_s else "each tick (`loop.rate_hz`, 10 Hz)"
    unit = OTHER_UNITS.get(output.subject) or unit_of(output.subject)
    return f"| `{output.subject}/{output.source}` | {output.type_name} | {unit} | {rate} | {output.doc} |"


def _messages() -> str:
    blocks = ["\n## Our messages\n"]
    for name, fields in TABLE.items():
        if name in ("Row", "Ages", "Codes"):
            continue
        rows = [f"| `{field}` | {_kind(kind)} | {meaning_of(name, field)} |" for field, kind in fields]
        head = [f"\n### shiptwin.{name}\n", "| field | type | what |", "|---|---|---|"]
        blocks.append("\n".join([*head, *rows, ""]))
    channels = ", ".join(f"`{name}`" for name in BY_NAME)
    codes = ", ".join(f"{int(code)} {words}" for code, words in WORDS.items())
    blocks.append(
        "\n### shiptwin.Row, shiptwin.Ages, shiptwin.Codes\n\n"
        f"One optional field a channel, by the channel's name: {channels}. `Row` has `time_s` in "
        f"front; `Ages` are seconds; `Codes` are: {codes}.\n\n"
        "`north_m` and `east_m` are what was sailed towards true north and true east since the voyage's "
        "datum: over any length, but no map (docs/live.md). The place on earth is `location_fix`.\n"
    )
    return "".join(blocks)


def made() -> dict[Path, bytes]:
    """Every file that is made, and what shall be in it."""
    return {
        DOCS / "bus.md": page().encode(),
        SHIPPED / "shiptwin.proto": proto().encode(),
        SHIPPED / "shiptwin.desc": descriptors(),
        SHIPPED / "subjects.yaml": subjects().encode(),
    }


if __name__ == "__main__":
    for path, data in made().items():
        path.write_bytes(data)
        print(f"{path}: {len(data)} bytes")
