"""Reads a file with somebody else's reader: read.py READER FILE.

Standard output is one line of JSON, {"shape": [slices, rows, columns, channels], "dtype": ...},
then all values as little-endian f64: slice by slice, row 0 first, row by row, channels side by side.
"dtype" is what the reader says the file stores; integers are given as they are, not divided.
"splitsum" is the metadata of each slice, where the reader finds it. A file that the reader refuses
is exit code 1 with the reason on standard error.
"""

import json
import sys


def read_numpy(path):
    import numpy

    array = numpy.load(path, allow_pickle=False)
    # Whatever is missing of (slices, rows, columns, channels): (rows, columns) has one channel.
    if array.ndim == 2:
        array = array[..., None]
    if array.ndim == 3:
        array = array[None]
    return array, None


def read_openexr(path):
    import numpy
    import OpenEXR

    parts = OpenEXR.File(path, separate_channels=True).parts
    slices = []
    for part in parts:
        # The file has its channels sorted by name: bring R, G, B, A into that order.
        names = sorted(part.channels, key=lambda name: ("RGBA".find(name) % 5, name))
        slices.append(numpy.stack([part.channels[name].pixels for name in names], axis=-1))
    return numpy.stack(slices), [part.header.get("splitsum") for part in parts]


def read_openimageio(path):
    import numpy
    import OpenImageIO as oiio

    config = oiio.ImageSpec()
    # Or it multiplies the colours by alpha.
    config.attribute("oiio:UnassociatedAlpha", 1)
    file = oiio.ImageInput.open(path, config)
    if file is None:
        raise ValueError(oiio.geterror())
    slices, texts = [], []
    # A part of an EXR file is a subimage.
    for part in range(1024):
        if not file.seek_subimage(part, 0):
            break
        spec = file.spec()
        # Of a volume in a .dds it would give the first slice and zeros.
        if spec.depth != 1:
            raise ValueError("a volume")
        pixels = file.read_image(part, 0, 0, spec.nchannels, oiio.UNKNOWN)
        if pixels is None:
            raise ValueError(file.geterror())
        slices.append(pixels.reshape(spec.height, spec.width, spec.nchannels))
        texts.append(spec.get("splitsum"))
    return numpy.stack(slices), texts


def read_panda3d(path):
    import numpy
    from panda3d import core

    texture = core.Texture()
    if not texture.read(core.Filename.from_os_specific(path)):
        raise ValueError("panda3d refuses it")
    types = {
        core.Texture.T_unsigned_byte: "u1",
        core.Texture.T_unsigned_short: "<u2",
        core.Texture.T_half_float: "<f2",
        core.Texture.T_float: "<f4",
    }
    array = numpy.frombuffer(texture.get_ram_image().get_data(), types[texture.component_type])
    shape = texture.z_size, texture.y_size, texture.x_size, texture.num_components
    # Rows are bottom-up, and the slices of a volume (but not of an array) are in reverse.
    array = array.reshape(shape)[:, ::-1]
    if texture.texture_type == core.Texture.TT_3d_texture:
        array = array[::-1]
    # Blue comes first, red third.
    if texture.num_components >= 3:
        array = array[..., [2, 1, 0, 3][: texture.num_components]]
    return array, None


def read_pillow(path):
    import numpy
    from PIL import Image

    with open(path, "rb") as file:
        head = file.read(26)
    image = Image.open(path)
    # Of 16 bits of colour Pillow keeps the upper 8 and says nothing; it reads 16 bits of grey.
    depth, colour = head[24], head[25]
    if head[1:4] == b"PNG" and depth == 16 and colour != 0:
        raise ValueError("Pillow reads 16 bits of colour as 8")
    array = numpy.asarray(image)
    if array.ndim == 2:
        array = array[..., None]
    return array[None], [image.info.get("splitsum")]


READERS = {
    "numpy": read_numpy,
    "openexr": read_openexr,
    "openimageio": read_openimageio,
    "panda3d": read_panda3d,
    "pillow": read_pillow,
}


def main():
    if len(sys.argv) != 3 or sys.argv[1] not in READERS:
        sys.exit(f"usage: read.py {{{','.join(READERS)}}} FILE")
    try:
        array, texts = READERS[sys.argv[1]](sys.argv[2])
    except ImportError:
        # Not the file's fault: leave the traceback.
        raise
    except Exception as error:
        sys.exit(f"{sys.argv[1]}: {type(error).__name__}: {error}")
    told = {"shape": list(array.shape), "dtype": array.dtype.name}
    if texts and any(texts):
        told["splitsum"] = texts
    sys.stdout.buffer.write(json.dumps(told).encode() + b"\n" + array.astype("<f8").tobytes())


if __name__ == "__main__":
    main()
