"""Writes docs/aluminium.md from a run's analysis and comparison: scripts/texture calls it.

    python3 scripts/texture_page.py RUN PAGE NAME
"""
import csv
import json
import os
import shutil
import sys

# Section 3.3 of the paper: mean spreads [degrees] and their correlations, 3,000 grains.
paper_spread = {0.42: (4.1, 5.1), 0.77: (5.5, 6.4), 1.2: (6.5, 7.0)}
paper_correlation = {0.77: (0.82, 0.78), 1.2: (0.89, 0.88)}


def rows(path):
    with open(path, newline="") as table:
        return list(csv.DictReader(table))


def near(strain, table):
    return next((k for k in table if abs(k - float(strain)) < 5e-3), None)


def correlation(x, y):
    n, mx, my = len(x), sum(x) / len(x), sum(y) / len(y)
    xy = sum((a - mx) * (b - my) for a, b in zip(x, y))
    xx, yy = sum((a - mx) ** 2 for a in x), sum((b - my) ** 2 for b in y)
    return xy / (xx * yy) ** 0.5 if n > 1 and xx > 0 and yy > 0 else float("nan")


def spreads_at(run, strain):
    """Spreads of the grains that count, by grain, at the stored strain nearest to `strain`."""
    return {int(r["grain"]): float(r["spread"]) for r in rows(os.path.join(run, "spreads.csv"))
            if abs(float(r["strain"]) - strain) < 5e-3 and r["counted"] == "1"}


def spread_table(run):
    text = ["| strain | mean spread here | paper, finite elements | paper, experiment |",
            "|---|---|---|---|"]
    for strain, (elements, experiment) in paper_spread.items():
        here = spreads_at(run, strain)
        if here:
            text.append(f"| {strain} | {sum(here.values()) / len(here):.2f} deg | {elements} deg | "
                        f"{experiment} deg |")
    return text


def correlation_table(run):
    text = ["| from, to strain | correlation here | paper, finite elements | paper, experiment |",
            "|---|---|---|---|"]
    before = 0.42
    for strain, (elements, experiment) in paper_correlation.items():
        x, y = spreads_at(run, before), spreads_at(run, strain)
        grains = sorted(set(x) & set(y))
        if grains:
            r = correlation([x[g] for g in grains], [y[g] for g in grains])
            text.append(f"| {before}, {strain} | {r:.2f} | {elements} | {experiment} |")
        before = strain
    return text


def texture_table(run):
    text = ["| strain | component | run | Taylor |", "|---|---|---|---|"]
    for r in rows(os.path.join(run, "analysis", "compare.csv")):
        if near(r["strain"], paper_spread):
            text.append(f"| {float(r['strain']):.4g} | {r['component']} | "
                        f"{float(r['intensity_run']):.2f} | {float(r['intensity_taylor']):.2f} |")
    return text


def findings(run):
    """The paper's findings at the last common strain, as they come out here."""
    table = rows(os.path.join(run, "analysis", "compare.csv"))
    last = max(float(r["strain"]) for r in table)
    at = {r["component"]: (float(r["intensity_run"]), float(r["intensity_taylor"]))
          for r in table if float(r["strain"]) == last}
    strongest = max(at.values(), key=lambda v: v[1])

    def line(what, holds, numbers):
        return f"- {what}: **{'yes' if holds else 'no'}** ({numbers})"

    copper, brass = at["copper"], at["brass"]
    return [
        line(f"Taylor's texture is stronger at strain {last:.4g}, in its strongest component",
             strongest[1] > strongest[0], f"{strongest[1]:.2f} against {strongest[0]:.2f}"),
        line("Taylor has more copper", copper[1] > copper[0], f"{copper[1]:.2f} against {copper[0]:.2f}"),
        line("Taylor has less brass, relative to copper",
             brass[1] / copper[1] < brass[0] / copper[0],
             f"brass over copper {brass[1] / copper[1]:.2f} against {brass[0] / copper[0]:.2f}; "
             f"brass alone {brass[1]:.2f} against {brass[0]:.2f}")]


def main(run, page, name):
    with open(os.path.join(run, "summary.json")) as file:
        summary = json.load(file)
    folder = os.path.join(os.path.dirname(os.path.abspath(page)), "aluminium")
    os.makedirs(folder, exist_ok=True)
    figures = ["compare-odf-rodrigues.svg", "compare-pole-figures.svg", "compare-components.svg",
               "compare-beta-fibre.svg", "compare-stress.svg", "spread-distribution.svg",
               "spread-correlation.svg", "rotation-paths.svg"]
    for figure in figures:
        source = os.path.join(run, "analysis", figure)
        if os.path.exists(source):
            shutil.copy(source, folder)
    grains, elements = summary["grains"], summary["elements_initial"]
    inner = len(spreads_at(run, summary["final_strain"]))
    remeshings = ", ".join(f"{r['strain']:.4g}" for r in summary["remeshings"]) or "no strain"
    text = [f"# {name}: the paper's findings",
            "", "Written by `scripts/texture`; do not edit.", "",
            f"{grains} grains, {elements} elements at first ({elements / grains:.0f} a grain), "
            f"{summary['elements_final']} at last, to strain {summary['final_strain']:.4g}, remeshed at "
            f"{remeshings}; {summary['steps']} steps, {sum(summary['cpu_s'].values()):.0f} s of CPU. "
            f"Textures of all grains and of the Taylor model of their initial orientations, spreads of the {inner} "
            "inner grains. Definitions: [texture.md](texture.md).", "", "## Textures", ""]
    text += findings(run) + [""] + texture_table(run)
    text += ["", "## In-grain spreads", ""] + spread_table(run) + [""] + correlation_table(run)
    text += ["", f"The paper has 1,972 inner grains at 136 elements a grain. Fewer elements a grain "
             "resolve less of a spread, and the standard error of a mean over "
             f"{inner} grains is that of the scatter in `spreads.csv` over the root of {inner}.", "",
             "## Figures", ""]
    for figure in figures:
        if os.path.exists(os.path.join(folder, figure)):
            text.append(f"![{figure[:-4]}](aluminium/{figure})\n")
    with open(page, "w") as out:
        out.write("\n".join(text))


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
