"""Write the inputs that fuzzing starts from: seeds.py FOLDER makes FOLDER/READER/* for every reader."""

import sys
from pathlib import Path

import tile_seeds

TEXT = [
    "1 2\n3 4\n",
    "1,2\r\n3 , 4\r\n",
    "# head\n\n  1\t2 # tail\n3 4",
    "1.0D+03 -2.5d-1 +3 .5 6.",
    "\ufeff7 nan -Inf infinity",
    "1e-400 -1e-400 1D-400 3.4028235e38 1.401298464324817e-45 16777217",
    "12 ****\n",
    "1,,2\n",
    "1,2,\n3,4\n5 , 6 ,\t# end\r\n",
    "1 2\n3\n",
    "9" * 400 + "e-400 0." + "0" * 300 + "1",
]

HEADERS = [
    "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }",
    '{"shape":(6,),"fortran_order":False,"descr":"<f8"}',
    "{'descr': '<f4', 'fortran_order': True, 'shape': (), }",
    "{'descr': '|O', 'fortran_order': False, 'shape': (0, 3), }",
    "{'descr': '>f8', 'fortran_order': True, 'shape': (3, 1)}",
    "{'descr': '<i2', 'fortran_order': True, 'shape': (2, 3, 2)}",
    "{'descr': '>u4', 'fortran_order': False, 'shape': (2, 3)}",
    "{'descr': '|i1', 'fortran_order': True, 'shape': (4, 6)}",
    "{'descr': '<i8', 'fortran_order': False, 'shape': (3,)}",
    "{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (18446744073709551615, 2)}",
]


def npy_file(header: str, data: bytes) -> bytes:
    return b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header.encode() + data


def seeds() -> dict[str, list[bytes]]:
    """Seeds by reader, in the formats of fuzz_*.cpp."""
    text = [t.encode() for t in TEXT]
    data = bytes(range(24))
    npy = [b"\x01" + h.encode() + b"\n" + data for h in HEADERS]
    npy += [b"\x00" + npy_file(h, data) for h in HEADERS]
    whole = [bytes([i]) + t for i in range(9) for t in text[:4]]
    whole += [bytes([i]) + npy_file(HEADERS[0], data) for i in (2, 5, 7)]
    whole += [bytes([i]) + axis for i in (1, 4) for axis in (b"179.9 -180 -179.9\n", b"239.4,239.5,239.6,\n")]
    pieced = [bytes([piece]) + t for t in text for piece in (0, 6, 255)]
    return {"text": pieced, "npy": npy, "run": whole} | tile_seeds.seeds()


def main(folder: Path) -> None:
    for reader, inputs in seeds().items():
        (folder / reader).mkdir(parents=True, exist_ok=True)
        for index, content in enumerate(inputs):
            (folder / reader / f"{index:02d}").write_bytes(content)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
