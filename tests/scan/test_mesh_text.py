"""Text of meshes: what a file holds is compared with what it states."""

import numpy as np
import pytest
from stated import read_scan

from fractalcontact.core.errors import InputError

NX, NY = 14, 11
MM = {"unit": "mm"}


def vertices(decimals=4):
    y, x = np.indices((NY, NX))
    z = np.random.default_rng(4).uniform(-0.2, 0.2, x.shape)
    return np.round(np.column_stack([x.ravel(), y.ravel(), z.ravel()]), decimals)


def quads():
    first = (np.arange(NY - 1)[:, None] * NX + np.arange(NX - 1)).ravel()
    return np.column_stack([first, first + 1, first + NX + 1, first + NX])


def triangles():
    return np.concatenate([quads()[:, [0, 1, 2]], quads()[:, [0, 2, 3]]])


def expected():
    return vertices()[:, 2].reshape(NY, NX)


def ply_lines(faces=None, names="x y z", comments=(), form="%.4f"):
    """Header and body of an ASCII PLY file."""
    faces = triangles() if faces is None else faces
    points = vertices()
    head = ["ply", "format ascii 1.0", *comments, f"element vertex {len(points)}"]
    head += [f"property double {name}" for name in names.split()]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    body = [" ".join(form % value for value in point) for point in points]
    return head, body + [" ".join(map(str, [len(face), *face])) for face in faces]


def obj_lines(faces=None, form="%.4f", gap=" "):
    faces = triangles() if faces is None else faces
    points = [gap.join(["v", *(form % value for value in point)]) for point in vertices()]
    return points + [gap.join(["f", *map(str, np.asarray(face) + 1)]) for face in faces]


def stl_lines():
    lines = ["solid rock"]
    for corners in vertices()[triangles()]:
        lines += ["  facet normal 0 0 1", "    outer loop"]
        lines += ["      vertex {:.4f} {:.4f} {:.4f}".format(*corner) for corner in corners]
        lines += ["    endloop", "  endfacet"]
    return [*lines, "endsolid rock"]


def save(path, lines, end="\n"):
    path.write_text("\n".join(lines) + end)
    return path


# --- what stands in a file is read ---------------------------------------------------------------


@pytest.mark.parametrize("faces", [triangles(), quads(), [*quads()[:9], *triangles()[9:]]])
def test_triangles_and_polygons_of_ply_and_obj(tmp_path, faces):
    """Polygons are divided into triangles, and the vertices stay where they are."""
    head, body = ply_lines(faces)
    for path, lines in (("rock.ply", head + body), ("rock.obj", obj_lines(faces))):
        heights = read_scan(save(tmp_path / path, lines), MM)
        np.testing.assert_array_equal(heights, expected())
        assert heights.attrs["layout"] == "mesh"


@pytest.mark.parametrize("is_binary", [False, True])
@pytest.mark.parametrize("names", ["x y z", "X Y Z"])
@pytest.mark.parametrize(
    "comments", [["obj_info end_header"], ["comment by end_header", "", "obj_info num_cols 512"]]
)
def test_headers_of_ply(tmp_path, is_binary, names, comments):
    """No word of a comment ends the header, and coordinates may have capitals."""
    head, body = ply_lines(names=names, comments=comments)
    path = tmp_path / "rock.ply"
    if not is_binary:
        save(path, head + body)
    else:
        head[1] = "format binary_little_endian 1.0"
        faces = np.empty(len(triangles()), dtype=[("n", "u1"), ("corners", "<i4", 3)])
        faces["n"], faces["corners"] = 3, triangles()
        content = vertices().astype("<f8").tobytes() + faces.tobytes()
        path.write_bytes("\n".join([*head, ""]).encode() + content)
    np.testing.assert_array_equal(read_scan(path, MM), expected())


def test_columns_of_ply_stand_in_any_order_among_others(tmp_path):
    head, body = ply_lines(names="z red x y")
    body[: len(vertices())] = [f"{z} 7 {x} {y}" for x, y, z in vertices()]
    np.testing.assert_array_equal(
        read_scan(save(tmp_path / "rock.ply", head + body), MM), expected()
    )


@pytest.mark.parametrize("gap", ["\t", "  ", " \t "])
@pytest.mark.parametrize("before", ["", "  ", "\t"])
def test_an_obj_file_with_tabs_and_blanks(tmp_path, gap, before):
    lines = [before + line for line in obj_lines(gap=gap)]
    np.testing.assert_array_equal(read_scan(save(tmp_path / "rock.obj", lines), MM), expected())


def test_objects_normals_textures_and_negative_corners_of_obj(tmp_path):
    points, faces = obj_lines()[: NX * NY], triangles()
    lines = ["mtllib none.mtl", "# 3 vertex normals", "o rock", *points, "vn 0 0 1", "vt 0 0"]
    lines += [
        "usemtl a",
        "g one",
        *(f"f {a + 1}/1/1 {b + 1}/1/1 {c + 1}/1/1" for a, b, c in faces[:70]),
    ]
    lines += [
        "usemtl b",
        "g two",
        *(f"f {a - NX * NY} {b + 1}//1 {c + 1}" for a, b, c in faces[70:]),
    ]
    heights = read_scan(save(tmp_path / "rock.obj", lines), MM)
    np.testing.assert_array_equal(heights, expected())
    assert heights.attrs["duplicated_points"] == 0


def test_an_obj_file_without_faces_is_a_cloud(tmp_path):
    lines = obj_lines()[: NX * NY]
    np.testing.assert_array_equal(read_scan(save(tmp_path / "rock.obj", lines), MM), expected())


# --- what is cut off is refused ------------------------------------------------------------------


@pytest.mark.parametrize("share", [0.2, 0.5, 0.999])
def test_fewer_lines_than_a_ply_file_states(tmp_path, share):
    head, body = ply_lines()
    path = save(tmp_path / "rock.ply", head + body[: int(share * len(body))])
    stated = f"states {NX * NY} x vertex and {2 * (NX - 1) * (NY - 1)} x face"
    with pytest.raises(InputError, match=rf"rock\.ply: .*{stated}.* cut off or damaged"):
        read_scan(path, MM)


def test_more_lines_than_a_ply_file_states(tmp_path):
    head, body = ply_lines()
    with pytest.raises(InputError, match=f"but {len(body) + 1} lines stand below it"):
        read_scan(save(tmp_path / "rock.ply", [*head, *body, "3 0 1 2"]), MM)


@pytest.mark.parametrize("bad", ["0.5 1", "0.5 1 2 3", "0.5 1 x", "0.5,1,2"])
def test_a_line_that_is_no_vertex_is_named(tmp_path, bad):
    head, body = ply_lines()
    body[4] = bad
    with pytest.raises(
        InputError, match=rf"line {len(head) + 5} holds '{bad}', not the numbers of"
    ):
        read_scan(save(tmp_path / "rock.ply", head + body), MM)
    lines = obj_lines()
    lines[4] = f"v {bad}"
    if bad != "0.5 1 2 3":  # a weight
        with pytest.raises(InputError, match=f"line 5 holds 'v {bad}', not the numbers of"):
            read_scan(save(tmp_path / "rock.obj", lines), MM)


@pytest.mark.parametrize("bad", ["3 0 1", "4 0 1 2", "3 0 1 2 3", "-3 0 1 2"])
def test_a_line_that_is_no_face_is_named(tmp_path, bad):
    head, body = ply_lines()
    body[-2] = bad
    number = len(head) + len(body) - 1
    with pytest.raises(
        InputError, match=f"line {number} holds '{bad}', not the numbers of one face"
    ):
        read_scan(save(tmp_path / "rock.ply", head + body), MM)


@pytest.mark.parametrize("ending", ["ply", "obj"])
@pytest.mark.parametrize("holds", ["points", "mesh"])
def test_a_mesh_that_ends_inside_a_number(tmp_path, ending, holds):
    """The last exponent, or the last corner of the last face, is not whole."""
    faces = triangles()[:0] if holds == "points" else triangles()
    head, body = ply_lines(faces, form="%.4e")
    lines = head + body if ending == "ply" else obj_lines(faces, form="%.4e")
    path = tmp_path / f"rock.{ending}"
    cut = 4 if holds == "points" else 2
    lines[-1] = lines[-1][:-cut]
    with pytest.raises(InputError, match="breaks off within a number"):
        read_scan(save(path, lines, end=""), MM)


@pytest.mark.parametrize("left", ["f 1 2", "f 1", "f", "f 1 2 99999999999999999999", "f 0 1 2"])
@pytest.mark.parametrize("end", ["", "\n"])
def test_a_face_of_obj_without_three_corners_is_refused(tmp_path, left, end):
    lines = [*obj_lines()[:-1], left]
    with pytest.raises(
        InputError, match=f"line {len(lines)} holds '{left}', not the numbers of one"
    ):
        read_scan(save(tmp_path / "rock.obj", lines, end), MM)


@pytest.mark.parametrize(
    "comment", ["# Vertices: {n}", "# {n} vertices", "# {n} vertices, 0 vertices normals"]
)
def test_fewer_vertices_than_a_comment_of_obj_states(tmp_path, comment):
    path = tmp_path / "rock.obj"
    lines = [comment.format(n=NX * NY), *obj_lines()]
    np.testing.assert_array_equal(read_scan(save(path, lines), MM), expected())
    lines = [comment.format(n=NX * NY + 1), *obj_lines()]
    with pytest.raises(InputError, match=f"states {NX * NY + 1} vertices, the file holds"):
        read_scan(save(path, lines), MM)


@pytest.mark.parametrize("share", [0.3, 0.71, 0.998])
def test_a_text_of_stl_that_is_cut_off(tmp_path, share):
    lines = stl_lines()
    path = save(tmp_path / "rock.stl", lines)
    np.testing.assert_array_equal(read_scan(path, MM), expected())
    path.write_text(path.read_text()[: int(share * path.stat().st_size)])
    with pytest.raises(InputError, match=r"1 solids begin in it and 0 end, .*cut off or damaged"):
        read_scan(path, MM)


def test_a_text_of_stl_that_lost_a_number_is_refused(tmp_path):
    lines = stl_lines()
    lines[10] = lines[10].rsplit(" ", 1)[0]
    with pytest.raises(InputError, match="whole vertices; the file is cut off or damaged"):
        read_scan(save(tmp_path / "rock.stl", lines), MM)
