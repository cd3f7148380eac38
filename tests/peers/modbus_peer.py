"""A Modbus server by pymodbus, independent of ours and of libmodbus, with a plant behind its registers.

modbus_peer.py (--tcp PORT | --serial DEVICE) --plant PORT
--tcp 0 takes a free port. Says "ready PORT" or "ready DEVICE".
"""
import argparse
import asyncio
import socket
import struct

from pymodbus import FramerType
from pymodbus.datastore import ModbusServerContext
from pymodbus.datastore.context import ModbusBaseSlaveContext
from pymodbus.server import ModbusSerialServer, ModbusTcpServer

WORDS = 18


class Plant(ModbusBaseSlaveContext):
    """Registers 0 to 17, in the plant's own process."""

    def __init__(self, port):
        self.line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.line.connect(("127.0.0.1", port))
        self.line.settimeout(5)

    def ask(self, question):
        self.line.send(question)
        return struct.unpack(">18H", self.line.recv(64))

    def reset(self):
        pass

    def validate(self, fc_as_hex, address, count=1):
        return fc_as_hex in (3, 4, 6, 16, 23) and address + count <= WORDS

    def getValues(self, fc_as_hex, address, count=1):
        return list(self.ask(b"R")[address : address + count])

    def setValues(self, fc_as_hex, address, values):
        self.ask(struct.pack(f">cHH{len(values)}H", b"W", address, len(values), *values))


async def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tcp", type=int)
    parser.add_argument("--serial")
    parser.add_argument("--plant", type=int, required=True)
    arg = parser.parse_args()
    context = ModbusServerContext(slaves=Plant(arg.plant), single=True)
    if arg.serial:
        server = ModbusSerialServer(context, framer=FramerType.RTU, port=arg.serial, baudrate=115200)
        name = arg.serial
    else:
        port = arg.tcp
        if not port:
            with socket.socket() as s:
                s.bind(("127.0.0.1", 0))
                port = s.getsockname()[1]
        server = ModbusTcpServer(context, address=("127.0.0.1", port))
        name = port
    task = asyncio.create_task(server.serve_forever())
    while not server.transport:
        await asyncio.sleep(0.01)
    print("ready", name, flush=True)
    await task


asyncio.run(main())
