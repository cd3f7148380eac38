"""A recording's ticks and events as MCAP (mcap.dev), each a message of JSON."""
import json
import math
from typing import Any, Callable, Dict, Iterator, List, Sequence

from mcap.writer import Writer

from ethd_programs.files import Output
from ethd_programs.recording import Field, RecordedEvent, Ticks, utc_offset

_EVENT = {
    "type": "object",
    "properties": {"row": {"type": "integer"}, "kind": {"type": "string"}, "detail": {"type": "string"}},
}


def _tick_schema(fields: Sequence[Field]) -> Dict[str, Any]:
    def numbers(count: int) -> Dict[str, Any]:
        return {"type": "number"} if count == 1 else {"type": "array", "items": {"type": "number"}}

    properties = {f.name: {"description": f.unit, **numbers(len(f.columns))} for f in fields}
    return {"type": "object", "properties": properties}


def _message(names: List[str], row: Any) -> bytes:
    """JSON has no word for a number that isn't defined, and null is no number to a schema: such a field is left out."""
    fields = {}
    for name, value in zip(names, row):
        if all(map(math.isfinite, value)) if isinstance(value, list) else math.isfinite(value):
            fields[name] = value
    return json.dumps(fields, separators=(",", ":")).encode()


def _rows(piece: Any) -> Iterator[Any]:
    """Tuples of Python's numbers, and lists of them."""
    return zip(*(piece[name].tolist() for name in piece.dtype.names))


def _topic(writer: Writer, name: str, schema_name: str, schema: Dict[str, Any]) -> int:
    number = writer.register_schema(schema_name, "jsonschema", json.dumps(schema).encode())
    return int(writer.register_channel(name, "json", number))


def write(ticks: Ticks, events: List[RecordedEvent], out: str, folder: str, progress: Callable[[int, int], None]) -> None:
    names = [f.name for f in ticks.fields]
    offset, row, event, now = utc_offset(events), 0, 0, 0
    with Output(out, folder) as file:
        writer = Writer(file)
        writer.start(library="libethd")
        tick = _topic(writer, "/tick", "ethd.tick", _tick_schema(ticks.fields))
        happened = _topic(writer, "/events", "ethd.event", _EVENT)

        def put_events(before: float, instant: int, published: int) -> None:
            nonlocal event
            while event < len(events) and events[event].row <= before:
                message = json.dumps(events[event]._asdict(), ensure_ascii=False).encode()
                writer.add_message(happened, log_time=instant, publish_time=published, data=message)
                event += 1

        published = 0
        for piece, shifts in ticks.pieces():
            instants = (piece["time_ns"] + shifts).tolist()
            for values, now, recorded in zip(_rows(piece), instants, piece["time_ns"].tolist()):
                published = now if offset is None else recorded + offset
                put_events(row, now, published)
                writer.add_message(tick, log_time=now, publish_time=published, data=_message(names, values))
                row += 1
            progress(row, ticks.count)
        put_events(math.inf, now, published)
        writer.finish()
