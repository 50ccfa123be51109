#!/usr/bin/env python3
"""interop.py TRACE VTP PLY GLB GLB: reads exported files with nothing of lrbscope's and compares them: the same
points, faces and numbers everywhere, and the contacts of the trace. --count VTP: prints its polygons and segments."""
import base64
import json
import struct
import sys
import xml.etree.ElementTree as ElementTree

VTK_TYPES = {"Float64": "d", "Int64": "q", "Int32": "i", "UInt8": "B"}
PLY_TYPES = {"uchar": "B", "int": "i", "float": "f", "double": "d"}


def need(condition, message):
    if not condition:
        sys.exit("interop.py: " + message)


def vtp_array(element):
    kind = VTK_TYPES[element.get("type")]
    data = base64.b64decode(element.text)
    (size,) = struct.unpack("<Q", data[:8])
    need(len(data) == 8 + size, "a VTP array is not as long as it says")
    return list(struct.unpack("<%d%s" % (size // struct.calcsize(kind), kind), data[8:]))


def read_vtp(path):
    root = ElementTree.parse(path).getroot()
    need(root.get("header_type") == "UInt64" and root.get("byte_order") == "LittleEndian", path + ": another header")
    piece = root.find("PolyData/Piece")
    arrays = lambda tag: {a.get("Name"): vtp_array(a) for a in piece.find(tag)}
    cells = {}
    for tag in ("Verts", "Lines", "Polys"):
        found, begin = arrays(tag), 0
        cells[tag] = []
        for end in found["offsets"]:
            cells[tag].append(found["connectivity"][begin:end])
            begin = end
        need(len(cells[tag]) == int(piece.get("NumberOf" + tag)), path + ": another number of " + tag)
    points = arrays("Points")["Points"]
    return {
        "points": [points[i : i + 3] for i in range(0, len(points), 3)],
        "cells": cells,
        "data": arrays("CellData"),
    }


def read_ply(path):
    raw = open(path, "rb").read()
    head, body = raw.split(b"end_header\n", 1)
    elements, at = [], 0
    for line in head.decode().splitlines():
        words = line.split()
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append(words[1:])

    def number(kind):
        nonlocal at
        (value,) = struct.unpack_from("<" + PLY_TYPES[kind], body, at)
        at += struct.calcsize(PLY_TYPES[kind])
        return value

    out = {}
    for name, count, properties in elements:
        rows = []
        for _ in range(count):
            row = {}
            for p in properties:
                if p[0] == "list":
                    row[p[3]] = [number(p[2]) for _ in range(number(p[1]))]
                else:
                    row[p[1]] = number(p[0])
            rows.append(row)
        out[name] = rows
    need(at == len(body), path + ": bytes are left over")
    return out


def read_glb(path):
    raw = open(path, "rb").read()
    magic, version, size, json_size, json_kind = struct.unpack("<4sIIII", raw[:20])
    need(magic == b"glTF" and version == 2 and size == len(raw) and json_kind == 0x4E4F534A, path + ": no GLB")
    out = json.loads(raw[20 : 20 + json_size])
    out["bin"] = raw[20 + json_size + 8 :]
    return out


def glb_values(glb, number, kind, width):
    accessor = glb["accessors"][number]
    view = glb["bufferViews"][accessor["bufferView"]]
    flat = struct.unpack_from("<%d%s" % (accessor["count"] * width, kind), glb["bin"], view["byteOffset"])
    return [flat[i : i + width] for i in range(0, len(flat), width)]


def compare_vtp_ply(vtp, ply):
    need([[v["x"], v["y"], v["z"]] for v in ply["vertex"]] == vtp["points"], "PLY and VTP differ in their points")
    polygons = vtp["cells"]["Polys"]
    need([f["vertex_indices"] for f in ply["face"]] == polygons, "PLY and VTP differ in their faces")
    first = len(vtp["cells"]["Verts"]) + len(vtp["cells"]["Lines"])
    for name, values in vtp["data"].items():
        if name == "colour":
            found = [x for f in ply["face"] for x in (f["red"], f["green"], f["blue"], f["alpha"])]
            need(found == values[4 * first :], "PLY and VTP differ in their colours")
        else:
            need([f[name] for f in ply["face"]] == values[first:], "PLY and VTP differ in " + name)
    need([f["quality"] for f in ply["face"]] == vtp["data"]["tests"][first:], "quality is not the number of tests")


def compare_glb(vtp, glb):
    """The triangles stand where the polygons do: z of the run is y of glTF."""
    corners = []
    for node in glb["nodes"][1:]:
        need(node["name"] == glb["meshes"][node["mesh"]]["name"], "a node is not named as its mesh")
        for primitive in glb["meshes"][node["mesh"]]["primitives"]:
            if primitive["mode"] == 4:
                corners += glb_values(glb, primitive["attributes"]["POSITION"], "f", 3)
    # The node above turns (x, y, z) into (x, z, -y), and then moves it.
    moved = glb["nodes"][0]["translation"]
    found = [(p[0] + moved[0], p[1] - moved[2], p[2] + moved[1]) for p in corners]
    wanted = [vtp["points"][v] for cell in vtp["cells"]["Polys"] for v in cell]
    need(len(found) == len(wanted), "GLB and VTP differ in their corners")
    low = lambda rows, i: min(r[i] for r in rows)
    high = lambda rows, i: max(r[i] for r in rows)
    for i in range(3):
        for end in (low, high):
            need(abs(end(found, i) - end(wanted, i)) < 1e-6, "GLB and VTP differ in where they are")


def read_with_vtk(vtp_file, ply_file, glb_file, vtp):
    try:
        from vtkmodules.vtkIOGeometry import vtkGLTFReader
        from vtkmodules.vtkIOPLY import vtkPLYReader
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    except ImportError:
        print("skipped: VTK is not installed (Debian's python3-vtk9)")
        return

    def read(reader, path):
        reader.SetFileName(path)
        reader.Update()
        return reader.GetOutput()

    polygons, lines = len(vtp["cells"]["Polys"]), len(vtp["cells"]["Lines"])
    data = read(vtkXMLPolyDataReader(), vtp_file)
    need(data.GetNumberOfPolys() == polygons and data.GetNumberOfLines() == lines, "VTK reads other cells of VTP")
    for name, values in vtp["data"].items():
        array = data.GetCellData().GetArray(name)
        width = array.GetNumberOfComponents()
        found = [array.GetComponent(i, c) for i in range(array.GetNumberOfTuples()) for c in range(width)]
        need(found == values, "VTK reads other numbers " + name)
    need(read(vtkPLYReader(), ply_file).GetNumberOfPolys() == polygons, "VTK reads other faces of PLY")
    need(read(vtkGLTFReader(), glb_file).GetNumberOfCells() > polygons, "VTK reads too few cells of GLB")
    print("VTK: the same cells and numbers in VTP, PLY and GLB")


def main():
    if sys.argv[1] == "--count":
        cells = read_vtp(sys.argv[2])["cells"]
        print(len(cells["Polys"]), sum(len(c) - 1 for c in cells["Lines"]))
        return
    trace, vtp_file, ply_file, glb_file, all_file = sys.argv[1:]
    vtp = read_vtp(vtp_file)
    need(len(vtp["cells"]["Polys"]) > 100 and len(vtp["cells"]["Lines"]) > 0, "the run has hardly any faces")
    ply = read_ply(ply_file)
    compare_vtp_ply(vtp, ply)
    compare_glb(vtp, read_glb(glb_file))
    names = [node["name"] for node in read_glb(all_file)["nodes"][1:]]
    need(names == ["A", "A_wrapper", "B", "B_wrapper", "contact_curves"], "GLB has other parts: %s" % names)
    events = json.load(open(trace))["traceEvents"]
    begin = max(e["ts"] for e in events if e.get("cat") == "step" and e["name"].startswith("step"))
    contacts = [e for e in events if e.get("name") == "contact" and e["ts"] >= begin]
    kind, side = vtp["data"]["kind"], vtp["data"]["side"]
    for body in (0, 1):
        found = sum(n for n, k, s in zip(vtp["data"]["contacts"], kind, side) if k == 1 and s == body)
        need(found == len(contacts) > 0, "%d contacts of faces, where the trace has %d" % (found, len(contacts)))
    print("read as specified: %d faces with %d numbers each" % (len(vtp["cells"]["Polys"]), len(vtp["data"]) - 1))
    read_with_vtk(vtp_file, ply_file, glb_file, vtp)


main()
