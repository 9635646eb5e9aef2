"""A joint at a glance, from the atlas: what is pressed, where it touches, how it closes.

python docs/gallery/joint_at_a_glance.py results/paper/atlas.nc concrete_twin joint.png
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import xarray as xr


def draw(atlas: xr.DataTree, specimen: str) -> plt.Figure:
    """Composite topography and contact domain at the map offset, and closure curves."""
    contact = atlas[f"contact/{specimen}"].to_dataset()
    direction, offset = contact.attrs["map_direction"], contact.attrs["map_offset"]
    load, resolution = contact.attrs["map_load"], contact.attrs["map_resolution"]
    curves = atlas[f"closure/{specimen}"].to_dataset().sel(direction=direction)
    composite = atlas[f"joints/{specimen}/composite"]
    composite = composite.sel(offset=offset, method="nearest")
    domain = contact[f"in_contact_{resolution}"].sel(direction=direction)
    domain = domain.sel(offset=offset, normal_force=load, method="nearest")

    figure, (left, middle, right) = plt.subplots(
        1, 3, figsize=(9.5, 3.0), layout="constrained", width_ratios=(1.25, 1, 1.4)
    )
    side = domain.shape[1] * float(np.diff(domain[domain.dims[1]][:2])[0])
    height = domain.shape[0] * float(np.diff(domain[domain.dims[0]][:2])[0])
    extent = (0, side, 0, height)
    relief = left.imshow(composite, origin="lower", extent=extent, cmap="viridis")
    figure.colorbar(relief, ax=left)
    left.set_title(f"composite topography (mm)\nat v = {offset:g} mm", fontsize=9)
    rows, columns = np.nonzero(domain.values == 1)
    # A node is too small to be seen at this size: each gets a mark.
    cell_y, cell_x = height / domain.shape[0], side / domain.shape[1]
    middle.plot(
        (columns + 0.5) * cell_x, (rows + 0.5) * cell_y, ".", markersize=2.5, color="#b2182b"
    )
    middle.set(xlim=(0, side), ylim=(0, height), aspect="equal")
    pressure = float(curves["nominal_pressure"].sel(normal_force=load, method="nearest"))
    state = curves.sel(offset=offset, normal_force=load, method="nearest")
    state = state.sel(resolution=resolution)
    # Corrected for the perimeter, as everywhere, where enough nodes touch for that.
    corrected = bool(state["area_corrected_resolved"])
    fraction = 100 * float(state["area_corrected_share" if corrected else "area_share"])
    middle.set_title(
        f"contact domain at {pressure:.3g} MPa:\n$A_r/A_0$ = {fraction:.2g} %"
        + ("" if corrected else " (raw)"),
        fontsize=9,
    )
    for axes in (left, middle):
        axes.set_xlabel("x (mm)")
    left.set_ylabel("y (mm)")

    closure = curves["interface_closure"].sel(resolution=resolution)
    shown = [float(v) for v in closure["offset"] if int((closure.sel(offset=v) > 0).sum()) > 1]
    places = np.unique(np.linspace(0, len(shown) - 1, 5).round().astype(int))
    closure = closure.sel(offset=[shown[place] for place in places])
    colours = plt.get_cmap("viridis")(np.linspace(0, 0.85, closure.sizes["offset"]))
    for colour, curve in zip(colours, closure.transpose("offset", ...), strict=True):
        known = curve.notnull() & (curve > 0)
        label = f"v = {float(curve['offset']):g} mm"
        right.plot(curve[known], curves["nominal_pressure"][known], ".-", color=colour, label=label)
    right.set(xlabel="interface closure (mm)", ylabel="nominal pressure (MPa)")
    right.set_title("closure curves", fontsize=9)
    right.legend(fontsize=7, loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    figure.suptitle(atlas[f"specimens/{specimen}"].attrs["label"] or specimen, fontsize=10)
    return figure


def main(atlas_file: str, specimen: str, picture: str) -> None:
    """Draw a specimen of an atlas into a file."""
    with xr.open_datatree(atlas_file) as atlas:
        draw(atlas, specimen).savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
