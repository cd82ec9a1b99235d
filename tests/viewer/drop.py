"""Drops a file on a window, as file managers do (the XDND protocol): drop.py WINDOW FILE."""

import ctypes
import pathlib
import sys
import time

from window import load_x11

SELECTION_REQUEST, SELECTION_NOTIFY, CLIENT_MESSAGE = 30, 31, 33
LONG = ctypes.c_ulong


class ClientMessage(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", LONG), ("send_event", ctypes.c_int), ("display", ctypes.c_void_p),
                ("window", LONG), ("message_type", LONG), ("format", ctypes.c_int), ("data", ctypes.c_long * 5),
                ("padding", ctypes.c_long * 24)]


class SelectionRequest(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", LONG), ("send_event", ctypes.c_int), ("display", ctypes.c_void_p),
                ("owner", LONG), ("requestor", LONG), ("selection", LONG), ("target", LONG), ("property", LONG),
                ("time", LONG), ("padding", ctypes.c_long * 24)]


class SelectionNotify(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", LONG), ("send_event", ctypes.c_int), ("display", ctypes.c_void_p),
                ("requestor", LONG), ("selection", LONG), ("target", LONG), ("property", LONG), ("time", LONG),
                ("padding", ctypes.c_long * 24)]


class Event(ctypes.Union):
    _fields_ = [("type", ctypes.c_int), ("message", ClientMessage), ("request", SelectionRequest),
                ("notify", SelectionNotify)]


def drop(window, path):
    x11 = load_x11()
    x11.XCreateSimpleWindow.restype = LONG
    display = ctypes.c_void_p(x11.XOpenDisplay(None))
    atom = {name: x11.XInternAtom(display, name.encode(), 0) for name in (
        "XdndEnter", "XdndPosition", "XdndDrop", "XdndSelection", "XdndActionCopy", "XdndFinished", "text/uri-list")}
    source = x11.XCreateSimpleWindow(display, LONG(x11.XDefaultRootWindow(display)), 0, 0, 1, 1, 0, LONG(0), LONG(0))
    x11.XSetSelectionOwner(display, LONG(atom["XdndSelection"]), LONG(source), LONG(0))
    data = pathlib.Path(path).resolve().as_uri().encode() + b"\r\n"

    def send(to, event):
        x11.XSendEvent(display, LONG(to), 0, ctypes.c_long(0), ctypes.byref(event))
        x11.XFlush(display)

    def say(what, *numbers):
        event = Event()
        event.message = ClientMessage(type=CLIENT_MESSAGE, window=window, message_type=atom[what], format=32)
        for i, number in enumerate((source, *numbers)):
            event.message.data[i] = number
        send(window, event)

    say("XdndEnter", 5 << 24, atom["text/uri-list"])
    say("XdndPosition", 0, (100 << 16) + 100, 0, atom["XdndActionCopy"])
    say("XdndDrop", 0, 0)
    deadline = time.monotonic() + 30
    event = Event()
    while time.monotonic() < deadline:
        if not x11.XPending(display):
            time.sleep(0.005)
            continue
        x11.XNextEvent(display, ctypes.byref(event))
        if event.type == SELECTION_REQUEST:
            request = event.request
            x11.XChangeProperty(display, LONG(request.requestor), LONG(request.property), LONG(request.target), 8, 0,
                                data, len(data))
            answer = Event()
            answer.notify = SelectionNotify(type=SELECTION_NOTIFY, requestor=request.requestor,
                                            selection=request.selection, target=request.target,
                                            property=request.property, time=request.time)
            send(request.requestor, answer)
        elif event.type == CLIENT_MESSAGE and event.message.message_type == atom["XdndFinished"]:
            return True
    return False


if __name__ == "__main__":
    sys.exit(0 if drop(int(sys.argv[1]), sys.argv[2]) else 1)
