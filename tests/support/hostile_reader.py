"""Takes the place of the readers in the reader process: a file says how its reading goes wrong."""

import ctypes
import os
import socket
import time
from pathlib import Path

import numpy as np

import fractalcontact.scan.formats
from fractalcontact.core.errors import InputError
from fractalcontact.scan import reader_process
from fractalcontact.scan.raw import RawScan
from fractalcontact.scan.readers.arrays import read_npz

reader_process.BASE_SECONDS = 1
reader_process.PATIENCE = 60  # the machine may be busy
reader_process.BASE_MEMORY = 10**8


def hang():
    while True:
        pass


def eat():
    held = []
    while True:
        held.append(np.empty(10**6))


def eat_within_a_library():
    try:
        eat()
    except Exception as error:
        raise InputError("damaged") from error


def write_files():
    try:
        Path("written.txt").write_text("more than nothing", encoding="utf-8")
    except OSError as error:
        raise InputError(f"could not write: {error}") from error


def open_many():
    try:
        held = [socket.socket() for _ in range(1000)]
    except OSError as error:
        raise InputError(f"could not open: {error}") from error
    return held


def quote():
    raise InputError("rock: " + "\x1b[31m" + "x" * 10**6 + " export it again")


WAYS = {
    "quote": quote,
    "hang": hang,
    "sleep": lambda: time.sleep(60),
    "eat": eat,
    "eat within a library": eat_within_a_library,
    "crash": lambda: ctypes.string_at(0),
    "abort": os.abort,
    "leave": lambda: os._exit(0),
    "write": write_files,
    "open": open_many,
    "bug": lambda: {}["no such key"],
}


def read(path, options):
    if path.suffix == ".npz":
        return read_npz(path, options)
    way = path.read_text(encoding="utf-8")
    if way == "stack":
        return RawScan(np.zeros((2, 8, 10)), "matrix", "the test's own")
    if way in WAYS:
        WAYS[way]()
    return RawScan(np.arange(80.0).reshape(8, 10), "matrix", "the test's own", notes=(way,))


fractalcontact.scan.formats.read_raw = read
