"""Decodes shipped tables: decode.py FILE... writes FILE.npy, f32 (rows, columns, channels), rows as
the file stores them. Needs numpy, for .exr OpenEXR, for .ktx2 zstandard."""

import struct
import sys

import numpy


def ktx2(path):
    with open(path, "rb") as file:
        data = file.read()
    assert data[:12] == b"\xabKTX 20\xbb\r\n\x1a\n"
    form, _, width, height, _, _, _, _, scheme = struct.unpack_from("<9I", data, 12)
    start, length, raw = struct.unpack_from("<3Q", data, 80)
    # R16G16_SFLOAT
    assert form == 83
    level = data[start : start + length]
    if scheme == 2:
        import zstandard

        level = zstandard.ZstdDecompressor().decompress(level, max_output_size=raw)
    return numpy.frombuffer(level, "<f2").reshape(height, width, 2)


def exr(path):
    import OpenEXR

    found = OpenEXR.File(path, separate_channels=True).channels()
    names = sorted(found, key=lambda name: "RGBA".find(name) % 5)
    return numpy.stack([found[name].pixels for name in names], axis=-1)


for path in sys.argv[1:]:
    table = {"ktx2": ktx2, "exr": exr}[path.rsplit(".", 1)[1]](path)
    numpy.save(f"{path}.npy", table.astype("<f4"))
