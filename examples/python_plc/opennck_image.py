"""The PLC's side of `opennck serve MACHINE --image FILE`: plain Python 3, standard library only.

    from opennck_image import Image

    with Image("nck.image") as image:
        for step in image.steps():                     # ends with the NC
            step["DB31.DBX2.1"] = 1                    # controller enable of axis 1
            if step["DB31.DBX101.4"]:                  # gantry synchronization ready to start
                step["DB31.DBX29.4"] = 1
            image.answer(step)

The page `docs/plc_in_another_process.md` describes the file byte by byte. Two rules apply in Python:

* A word that the other side waits for is loaded and stored as one aligned word of 64 bits: through a memoryview cast to "Q", never
  byte by byte.
* Python has no memory barriers. On x86-64 stores become visible in order; elsewhere (ARM) this is not guaranteed. Every slot therefore
  ends with a checksum, and a reader repeats a read with a wrong checksum.
"""

import mmap
import operator
import os
import platform
import re
import struct
import sys
import time
import zlib

MAGIC = b"OpenNCK\0"
VERSION = 1

# The header.
GENERATION = 16
FILE_BYTES = 24
SECTIONS = 40
SECTION_TABLE = 48
SECTION_BYTES = 56
IMAGE_BYTES = 64
SLOTS = 72
NC_SLOTS = 80
NC_SLOT_BYTES = 88
PLC_SLOTS = 96
PLC_SLOT_BYTES = 104
LOCK_STEP = 120
PROCESS = 136
STATE = 256
NEWEST_STEP = 264
REQUEST = 272
PLC_STARTS = 512
NEWEST_ANSWER = 520
ACKNOWLEDGE = 528
POWER = 536

# STATE.
ENDED, RUN, STOP = 0, 1, 2

# The header has one page. A slot begins with its own 64 bytes, followed by the image.
PAGE, HEAD = 4096, 64

# Where stores become visible in their order, the numbers of a slot are sufficient, and the checksums are not needed.
IN_ORDER = platform.machine() in ("x86_64", "AMD64")
# An answer that lists its changes: the word after ANSWERS is their number plus one; each has an offset, the byte before and the byte after.
CHANGE = struct.Struct("<IBBxx")
STEP, ANSWER = struct.Struct("<6Q"), struct.Struct("<4Q")
# How long to look for the next step without a pause, in seconds; and between looks whether the NC still exists.
SPIN, LOOK = 0.0002, 0.5
# After how many seconds without an NC to report it.
REPORT = 1.0

WRITERS = {1: "PLC", 2: "NCK", 3: "HMI", 4: "machine"}

ADDRESS = re.compile(r"(?:DB(\d+)\.DB([XBWD])|([IQMTC])([BWD]?))(\d+)(?:\.([0-7]))?$")


class NotYet(Exception):
    """The reason why the image cannot be used yet."""


class Section:
    """Consecutive bytes of one area or data block with one writer."""

    def __init__(self, entry):
        kind, self.number, self.first, self.length, self.offset, writer, name = struct.unpack_from("<8s5Q32s", entry)
        self.kind = kind.rstrip(b"\0").decode(errors="replace")
        self.writer = WRITERS.get(writer)
        self.name = name.rstrip(b"\0").decode(errors="replace")
        if self.kind not in ("DB", "I", "Q", "M", "T", "C") or self.writer is None:
            raise NotYet(f"its section table is invalid: {self.kind!r} {self.number}, writer {writer}")


class Step:
    """One step of the NC: the published image, and the image changed by the PLC."""

    __slots__ = ("number", "cycle", "starts", "taken", "first_scan", "_time", "_since_last", "_slot", "_bytes", "_places", "_of_others", "_image", "_written")

    def __init__(self, image, slot):
        self.number, self.cycle, self._time, self._since_last, self.starts, self.taken = STEP.unpack_from(slot)
        self.first_scan = False
        self._slot = slot
        self._bytes = image.image_bytes
        self._places, self._of_others = image.places, image.of_others
        self._image = None
        self._written = {}  # the written bytes by offset

    @property
    def time(self):
        """The time of this cycle in seconds."""
        return self._time / 1e9

    @property
    def since_last(self):
        """The time since the last scan in seconds."""
        return self._since_last / 1e9

    @property
    def before(self):
        """The image as the NC published it."""
        return self._slot[HEAD : HEAD + self._bytes]

    @property
    def image(self):
        """The image as a bytearray, for a program that changes bytes by itself."""
        if self._image is None:
            self._image = bytearray(self.before)
            for offset in self._written:
                self._image[offset] = self._written[offset]
            self._written = self._image
        return self._image

    def __getitem__(self, address):
        offset, width, bit = self._places[address]
        written = self._written
        if self._image is not None:
            value = int.from_bytes(written[offset : offset + width], "big")
        elif not written:
            value = int.from_bytes(self._slot[HEAD + offset : HEAD + offset + width], "big")
        else:
            value = 0
            for at in range(offset, offset + width):
                value = value << 8 | written.get(at, self._slot[HEAD + at])
        return value if bit is None else value >> bit & 1

    def __setitem__(self, address, value):
        offset, width, bit = self._places[address]
        if offset in self._of_others or offset + width - 1 in self._of_others:
            writer = self._of_others.get(offset) or self._of_others[offset + width - 1]
            raise ValueError(f"{address}: the {writer} writes this byte, and the NC takes no change of the PLC there")
        try:
            number = operator.index(value)
        except TypeError:
            kind = "a number or a truth value" if bit is not None else "a whole number"
            raise TypeError(f"{address}: expected {kind}, found {value!r}") from None
        written = self._written
        if bit is None:
            least, most = -(1 << 8 * width - 1), (1 << 8 * width) - 1
            if not least <= number <= most:
                raise ValueError(f"{address}: expected a number from {least} to {most}, found {number}")
            for at, byte in enumerate(number.to_bytes(width, "big", signed=number < 0), offset):
                written[at] = byte
            return
        byte = written[offset] if self._image is not None else written.get(offset, self._slot[HEAD + offset])
        written[offset] = byte | 1 << bit if number else byte & ~(1 << bit) & 0xFF

    def changes(self):
        """The changed bytes: offset, before, after; None if the program has taken the whole image."""
        if self._image is not None:
            return None
        slot = self._slot
        return [(at, slot[HEAD + at], byte) for at, byte in self._written.items() if slot[HEAD + at] != byte]


class Places(dict):
    """Offset in the image, bytes, and bit of each address, looked up once."""

    def __init__(self, look_up):
        self._look_up = look_up

    def __missing__(self, address):
        place = self[address] = self._look_up(address)
        return place


def following(number):
    """The next number. It wraps around and skips 0, which means "none"."""
    return number + 1 & 0xFFFF_FFFF_FFFF_FFFF or 1


class Image:
    """The file. `wait` is the time in seconds to wait for an NC that serves it; its folder must exist. A wait of more than a second is
    reported once, on standard error.

    Create it when the program is ready: from then on an NC in lock-step waits for the first answer, with the same time-out as for any other.
    """

    def __init__(self, path, wait=10.0):
        if sys.byteorder != "little":
            raise OSError("the words of the file are little-endian; this computer's are not")
        self._path, self._wait = path, wait
        folder = os.path.dirname(os.path.abspath(path))
        if not os.path.isdir(folder):
            raise FileNotFoundError(f"no NC can serve {path}: the folder {folder} does not exist")
        self._open_soon()

    def _open_soon(self):
        begin = time.monotonic()
        end, is_reported = begin + self._wait, "OPENNCK_STARTED" in os.environ
        while True:
            try:
                self._open(self._path)
                return
            except NotYet as reason:
                now = time.monotonic()
                if now > end:
                    raise TimeoutError(f"no NC serves {self._path}: {reason}") from None
                if now - begin > REPORT and not is_reported:
                    is_reported = True
                    serve = f"opennck serve MACHINE --image {self._path}"
                    print(f"waiting for an NC that serves {self._path} ({reason}); start it with: {serve}", file=sys.stderr, flush=True)
            time.sleep(0.01)

    def _open(self, path):
        try:
            with open(path, "r+b") as file:
                size = os.fstat(file.fileno()).st_size
                if size < PAGE:
                    raise NotYet(f"its size of {size} bytes is too small for an image")
                self.map = mmap.mmap(file.fileno(), size // PAGE * PAGE)
        except FileNotFoundError:
            raise NotYet("the file does not exist") from None
        self.bytes = memoryview(self.map)
        self.words = self.bytes.cast("Q")
        try:
            self._begin(path)
        except BaseException:
            self.close()
            raise

    def _begin(self, path):
        """Reads the header. A header that is incomplete, or that another NC starts to write meanwhile, counts as missing."""
        self.generation = self.word(GENERATION)
        head = bytes(self.bytes[:16])
        if head[:8] != MAGIC:
            raise NotYet("it is not an image of the interface")
        if head[8:16] != struct.pack("<Q", VERSION):
            raise ValueError(f"{path} does not have version {VERSION}")
        if self.word(STATE) == ENDED:
            raise NotYet("its NC has ended or is about to start")
        self.image_bytes, self._slots = self.word(IMAGE_BYTES), self.word(SLOTS)
        self._nc_slots, self._nc_slot_bytes = self.word(NC_SLOTS), self.word(NC_SLOT_BYTES)
        self._plc_slots, self._plc_slot_bytes = self.word(PLC_SLOTS), self.word(PLC_SLOT_BYTES)
        table, size, count = self.word(SECTION_TABLE), self.word(SECTION_BYTES), self.word(SECTIONS)
        starts_and_sizes = (self._nc_slots, self._nc_slot_bytes, self._plc_slots, self._plc_slot_bytes)
        places = (
            all(number % 8 == 0 for number in starts_and_sizes)
            and PAGE <= table <= table + size * count <= self._nc_slots
            and size >= 80
            and 1 <= self._slots <= 1024
            and self._nc_slot_bytes >= HEAD + self.image_bytes + 8
            and self._plc_slot_bytes >= HEAD + 2 * self.image_bytes + 8
            and self._nc_slots + self._slots * self._nc_slot_bytes <= self._plc_slots
            and self._plc_slots + self._slots * self._plc_slot_bytes <= self.word(FILE_BYTES) <= len(self.bytes)
        )
        if not places:
            raise NotYet("its header is invalid")
        entries = bytes(self.bytes[table : table + size * count])
        self.sections = [Section(entries[size * n : size * (n + 1)]) for n in range(count)]
        if any(section.offset + section.length > self.image_bytes for section in self.sections):
            raise NotYet("its section table is invalid: a section ends beyond the image")
        self.places = Places(self._look_up)
        # The writer of each byte that the PLC does not write.
        self.of_others = {
            offset: section.writer
            for section in self.sections
            if section.writer != "PLC"
            for offset in range(section.offset, section.offset + section.length)
        }
        self._lock_step = self.word(LOCK_STEP) != 0
        self._process, self._own = self.word(PROCESS), os.getpid()
        # `opennck` starts a process for one NC; any other process may wait for the next NC.
        self._had_nc = self._nc_runs() or "OPENNCK_STARTED" in os.environ
        self._newest = 0
        self._starts = self._answered = None
        if not self.is_served():
            raise NotYet("another NC starts to serve it")
        self.store(PLC_STARTS, following(self.word(PLC_STARTS)))

    def close(self):
        self.words.release()
        self.bytes.release()
        self.map.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def word(self, offset):
        """Loads one aligned word."""
        return self.words[offset // 8]

    def store(self, offset, value):
        """Stores one aligned word."""
        self.words[offset // 8] = value

    def is_served(self):
        """Whether the NC of this session still serves the file."""
        return self.word(STATE) != ENDED and self.word(GENERATION) == self.generation

    def find(self, address):
        """Offset in the image, bytes, and bit of an address such as DB31.DBX4.7, DB31.DBD24, MW20 or Q4.0."""
        return self.places[address]

    def _look_up(self, address):
        match = ADDRESS.match(address)
        if not match:
            raise LookupError(f"{address}: write DB31.DBX4.7, DB31.DBB4, DB31.DBW4, DB31.DBD4, M10.3, QB4, IW6, MD8, T3 or C3")
        db, db_width, area, area_width, byte, bit = match.groups()
        kind, number, width = (area, 0, area_width) if area else ("DB", int(db), db_width)
        byte, bit = int(byte), bit and int(bit)
        if (bit is None) == (width in ("X", "") and kind not in "TC"):
            raise LookupError(f"{address}: only a bit address has a point and a number from 0 to 7")
        size = {"B": 1, "W": 2, "D": 4}.get(width, 1)
        if kind in "TC":
            byte, size = 2 * byte, 2
        if size > 1:  # all bytes, for every writer
            first, last = self._offset(kind, number, byte, address), self._offset(kind, number, byte + size - 1, address)
            if last - first != size - 1:
                raise LookupError(f"{address}: its bytes are not consecutive in the image")
        return self._offset(kind, number, byte, address), size, bit

    def _offset(self, kind, number, byte, address):
        for section in self.sections:
            if (section.kind, section.number) == (kind, number) and 0 <= byte - section.first < section.length:
                return section.offset + byte - section.first
        raise LookupError(f"{address}: the image does not have this byte")

    def newest(self):
        """The newest step, if it is newer than the last one and contains the last answer; else None."""
        words = self.words
        number = words[NEWEST_STEP // 8]
        if number == self._newest or not number:
            return None
        size = self._nc_slot_bytes
        start = self._nc_slots + number % self._slots * size
        slot = self.map[start : start + size]
        step = Step(self, slot)
        if step.number != number or words[start // 8] != number:
            return None  # it was being written
        if not IN_ORDER:
            checksum = struct.unpack_from("<Q", slot, size - 8)[0]
            if checksum not in (0, zlib.crc32(slot[:-8])):
                return None  # not all of it is visible yet
        if self._answered is not None and self._answered != step.taken:
            return None
        step.first_scan = step.starts != self._starts
        self._newest, self._starts = number, step.starts
        return step

    def steps(self, nap=0.00005):
        """The steps of the NC, while it serves the file and the PLC is in RUN; a slow program misses some.

        If the file was left by an NC that crashed, no step of it is returned: the steps begin with the next NC.
        """
        while True:
            begin = looked = time.perf_counter()
            words, generation = self.words, self.generation
            while (state := words[STATE // 8]) != ENDED and words[GENERATION // 8] == generation:
                # Most looks find nothing new; a look costs little.
                if state == RUN and words[NEWEST_STEP // 8] != self._newest and (step := self.newest()) is not None:
                    yield step
                    begin = time.perf_counter()
                    continue
                now = time.perf_counter()
                if self._lock_step and now - begin < SPIN:
                    continue  # an NC in lock-step goes on at once
                if now - looked > LOOK:
                    looked = now
                    if not self._nc_exists():
                        return
                time.sleep(nap)
            if self._newest or not self._has_another_nc():
                return
            self.close()
            self._open_soon()

    def _nc_exists(self):
        """Whether the NC of this session exists: one that was killed has not marked its end. A file that was left by an NC waits for the next."""
        return not self._had_nc or self._nc_runs()

    def _nc_runs(self):
        if os.name != "posix":
            return True
        try:
            os.kill(self._process, 0)
        except ProcessLookupError:
            return False
        except (PermissionError, OverflowError):
            pass
        return True

    def _has_another_nc(self):
        """Whether another NC starts to serve the file. It first marks the old one as ended."""
        end = time.monotonic() + 1
        while self.word(GENERATION) == self.generation:
            if time.monotonic() > end:
                return False
            time.sleep(0.01)
        return True

    def answer(self, step):
        """Publishes the answer of the PLC to a step. Only changed bits count as writes of the PLC; unchanged bits leave other writers' changes intact."""
        words = self.words
        if words[STATE // 8] == ENDED or words[GENERATION // 8] != self.generation:
            return  # the slots may be another NC's
        number = following(words[NEWEST_ANSWER // 8])
        size = self._plc_slot_bytes
        start = self._plc_slots + number % self._slots * size
        at = start // 8
        changes = step.changes() if IN_ORDER else None
        words[at] = 0  # it is being written
        if changes is not None and 8 * len(changes) <= self.image_bytes:
            words[at + 1], words[at + 2], words[at + 3] = step.number, len(changes) + 1, self._own
            if changes:
                begin = start + HEAD
                self.map[begin : begin + CHANGE.size * len(changes)] = b"".join([CHANGE.pack(*change) for change in changes])
            words[at + size // 8 - 1] = 0  # a list has no checksum
        else:
            head = ANSWER.pack(number, step.number, 0, self._own).ljust(HEAD, b"\0")
            slot = (head + step.before + step.image).ljust(size - 8, b"\0")
            slot += struct.pack("<Q", 0 if IN_ORDER else zlib.crc32(slot))
            self.map[start + 8 : start + size] = slot[8:]
        words[at] = number
        words[NEWEST_ANSWER // 8] = number
        words[ACKNOWLEDGE // 8] = step.number
        self._answered = number

    def power_off_and_on(self):
        """Switches the control off and on, which cancels alarm 2000."""
        self.store(POWER, following(self.word(POWER)))
