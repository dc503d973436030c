#!/usr/bin/python3
"""Figure 20 of the paper again, from the stored states of a run, with h5py and numpy only.

    python3 docs/python/spreads.py RUN [TABLE.csv]

Prints the mean in-grain spread at each stored strain and, with a second argument, writes every
grain's spread. With matplotlib installed it draws RUN/spreads-python.png too.
"""
import json
import os
import sys

import h5py
import numpy as np


def cubic_symmetries():
    """[24, 4] quaternions w x y z of the cube's proper rotations."""
    half, root = 0.5, np.sqrt(0.5)
    q = [np.eye(4)[0]]
    q += [np.eye(4)[i] for i in (1, 2, 3)]  # half turns about <100>
    for i in (1, 2, 3):  # quarter turns about <100>
        for sign in (1, -1):
            q.append(root * (np.eye(4)[0] + sign * np.eye(4)[i]))
    for i, j in ((1, 2), (2, 3), (3, 1)):  # half turns about <110>
        for sign in (1, -1):
            q.append(root * (np.eye(4)[i] + sign * np.eye(4)[j]))
    for signs in np.ndindex(2, 2, 2):  # thirds of a turn about <111>
        q.append(half * np.concatenate(([1], 1 - 2 * np.array(signs))))
    return np.array(q)


def multiply(p, q):
    """Hamilton's product of quaternions [..., 4]."""
    pw, px, py, pz = np.moveaxis(p, -1, 0)
    qw, qx, qy, qz = np.moveaxis(q, -1, 0)
    return np.stack((pw * qw - px * qx - py * qy - pz * qz, pw * qx + px * qw + py * qz - pz * qy,
                     pw * qy - px * qz + py * qw + pz * qx, pw * qz + px * qy - py * qx + pz * qw),
                    axis=-1)


def nearest_variants(q, reference, symmetries=cubic_symmetries()):
    """Of each crystal q [n, 4] the variant q S nearest to the reference, with its sign."""
    variants = multiply(q[:, None, :], symmetries[None, :, :])
    cosine = variants @ reference
    best = np.argmax(np.abs(cosine), axis=1)
    rows = np.arange(len(q))
    return variants[rows, best] * np.sign(cosine[rows, best])[:, None]


def grain_spread(q, volume):
    """Mean disorientation [degrees] from the grain's mean orientation, elements by volume."""
    mean = q[0]
    for _ in range(10):
        near = nearest_variants(q, mean)
        moment = (near * volume[:, None]).T @ near
        mean = np.linalg.eigh(moment)[1][:, 3]
        mean *= np.sign(mean @ near[0])
    cosine = np.clip(nearest_variants(q, mean) @ mean, -1, 1)
    return np.average(np.degrees(2 * np.arccos(cosine)), weights=volume)


def read_spreads(path):
    """Strain and the spreads of all grains in one stored state."""
    with h5py.File(path) as state:
        grain = state["mesh/grain"][:]
        q = state["elements/orientation"][:]
        volume = state["elements/volume"][:]
        strain = state["strain"][()]
    return float(strain), np.array([grain_spread(q[grain == g], volume[grain == g])
                             for g in range(1, grain.max() + 1)])


def main(run, table=None):
    with open(os.path.join(run, "results", "index.json")) as index:
        states = json.load(index)["states"]
    results, last = [], None
    for state in states:
        if last is not None and state["strain"] == last:
            continue  # the far side of a remeshing
        last = state["strain"]
        results.append(read_spreads(os.path.join(run, "results", state["file"])))
    for strain, spreads in results:
        print(f"strain {strain:.4g}: mean spread {spreads.mean():.4f} degrees, "
              f"{len(spreads)} grains")
    if table:
        with open(table, "w") as out:
            out.write("strain,grain,spread\n")
            for strain, spreads in results:
                for number, spread in enumerate(spreads, 1):
                    out.write(f"{strain!r},{number},{float(spread)!r}\n")
    try:
        import matplotlib.pyplot as plt
    except ImportError:
        return
    for strain, spreads in results:
        if spreads.mean() > 1e-6:
            plt.hist(spreads, bins=20, density=True, histtype="step", label=f"strain {strain:.4g}")
    plt.xlabel("mean disorientation of a grain (degrees)")
    plt.ylabel("density")
    plt.legend()
    plt.savefig(os.path.join(run, "spreads-python.png"), dpi=150)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(*sys.argv[1:])
