"""Runs the routines of a file for cognate, which writes frames to standard input: see python.rs."""
import importlib.util, json, os, signal, struct, sys, traceback, types

signal.signal(signal.SIGINT, signal.SIG_IGN)
source, sink = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
# what routines print does not run into the frames
os.dup2(2, 1)
sys.stdin, sys.stdout = open(0), open(1, "w", buffering=1, closefd=False)
sys.dont_write_bytecode = True
path = sys.argv[1]


def write(kind, data=b""):
    sink.write(struct.pack("<I", 1 + len(data)) + kind + data)
    sink.flush()


def read():
    head = source.read(4)
    if len(head) < 4:
        sys.exit()
    data = source.read(struct.unpack("<I", head)[0])
    return data[:1], data[1:]


def ask(kind, name, ids):
    ids = [ids] if isinstance(ids, (int, float)) else list(ids)
    name = str(name).encode()
    data = struct.pack("<I", len(name)) + name + struct.pack("<%di" % len(ids), *(int(i) for i in ids))
    write(kind, data)
    kind, data = read()
    if kind != b"v":
        raise ValueError("there is no function " + name.decode())
    return struct.unpack("<%dd" % (len(data) // 8), data)


def sysfnc(name, ids):
    """The value of a function of the model: sysfnc("DX", [12, 21])."""
    return ask(b"A", name, ids)[0]


def sysary(name, ids):
    """The values of several: sysary("TDISP", [12, 21])."""
    return list(ask(b"S", name, ids))


def say(ends, text):
    write(b"M", bytes([ends]) + str(text).encode())
    read()


def errmes(failed, text):
    """Ends the run with a message where something has failed."""
    if failed:
        say(1, text)


def usrmes(wanted, text):
    """Prints a message, once."""
    if wanted:
        say(0, text)


def mistake(error):
    """Returns what an exception says, with the last line of the user's file on its way."""
    if isinstance(error, SyntaxError) and error.filename == path:
        return "%s:%s: %s: %s" % (path, error.lineno, type(error).__name__, error.msg)
    lines = [f.lineno for f in traceback.extract_tb(error.__traceback__) if f.filename == path]
    place = "%s:%d: " % (path, lines[-1]) if lines else ""
    return place + traceback.format_exception_only(type(error), error)[-1].strip()


def flat(result):
    if result is None:
        return []
    if isinstance(result, (int, float)) or not hasattr(result, "__iter__"):
        return [float(result)]
    return [x for part in result for x in flat(part)]


def arguments(data):
    """Reads flags, whole numbers, numbers and lists."""
    at = 0
    while at < len(data):
        kind, at = data[at : at + 1], at + 1
        if kind == b"b":
            yield bool(data[at])
            at += 1
        elif kind == b"i":
            yield struct.unpack_from("<i", data, at)[0]
            at += 4
        elif kind == b"d":
            yield struct.unpack_from("<d", data, at)[0]
            at += 8
        else:
            n = struct.unpack_from("<I", data, at)[0]
            yield list(struct.unpack_from("<%dd" % n, data, at + 4))
            at += 4 + 8 * n


def load():
    sys.path.insert(0, os.path.dirname(path))
    spec = importlib.util.spec_from_file_location("routines", path)
    module = importlib.util.module_from_spec(spec)
    module.__dict__.update(sysfnc=sysfnc, sysary=sysary, errmes=errmes, usrmes=usrmes)
    sys.modules["routines"] = module
    spec.loader.exec_module(module)
    return module


def serve(module):
    elements = []
    while True:
        kind, data = read()
        if kind == b"F":
            is_there = callable(getattr(module, data.decode(), None))
            write(b"Y" if is_there else b"N")
        elif kind == b"D":
            elements.append(types.SimpleNamespace(**json.loads(data)))
            write(b"Y", struct.pack("<I", len(elements) - 1))
        else:
            element, n = struct.unpack_from("<II", data)
            function = getattr(module, data[8 : 8 + n].decode())
            try:
                numbers, *rest = arguments(data[8 + n :])
                elements[element].PAR = numbers
                result = flat(function(elements[element], *rest))
                write(b"R", struct.pack("<%dd" % len(result), *result))
            except BaseException as error:
                write(b"E", mistake(error).encode())


try:
    module = load()
except BaseException as error:
    write(b"E", mistake(error).encode())
else:
    write(b"Y")
    serve(module)
