"""Writes docs/aluminium.md from a run's analysis and comparison: scripts/texture calls it.

    python3 scripts/texture_page.py RUN ONE_MODE ALWAYS PAGE NAME

ONE_MODE, ALWAYS: folders of analyses that count inner grains of one mode only, at the paper's strains
or at every stored one.
"""
import csv
import json
import os
import shutil
import sys

# Section 3.3 of the paper: mean spreads [degrees] and their correlations; 1,972 inner grains of 3,000
# (finite elements), 182 grains (experiment), of which only those of one mode count (fig. 20).
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


def spreads_at(folder, strain):
    """Spreads of the grains that count, by grain, at the stored strain nearest to `strain`."""
    return {int(r["grain"]): float(r["spread"]) for r in rows(os.path.join(folder, "spreads.csv"))
            if abs(float(r["strain"]) - strain) < 5e-3 and r["counted"] == "1"}


def mean_and_error(values):
    """Mean over grains and its standard error."""
    n, mean = len(values), sum(values) / len(values)
    scatter = sum((v - mean) ** 2 for v in values) / max(n - 1, 1)
    return mean, (scatter / n) ** 0.5


def spread_table(folders):
    text = ["| strain | inner grains | of one mode then | of one mode always | paper, finite elements | "
            "paper, experiment |", "|---|---|---|---|---|---|"]
    for strain, (elements, experiment) in paper_spread.items():
        here = [list(spreads_at(folder, strain).values()) for folder in folders]
        if all(here):
            mine = " | ".join("{:.2f} +- {:.2f} deg".format(*mean_and_error(v)) for v in here)
            text.append(f"| {strain} | {mine} | {elements} deg | {experiment} deg |")
    return text


def growth(folders):
    """How much the means grow from the first of the paper's strains."""
    strains = list(paper_spread)

    def ratios(values):
        return " and ".join(f"{v / values[0]:.2f}" for v in values[1:])

    def means(folder):
        return [mean_and_error(list(spreads_at(folder, s).values()))[0] for s in strains]

    if not all(spreads_at(folders[0], s) for s in strains):
        return []
    return ["", f"From {strains[0]} to {strains[1]} and {strains[2]} the means grow to {ratios(means(folders[0]))} times "
            f"(one mode: {ratios(means(folders[1]))}, always: {ratios(means(folders[2]))}); the paper's finite elements to "
            f"{ratios([paper_spread[s][0] for s in strains])}, the experiment to "
            f"{ratios([paper_spread[s][1] for s in strains])}."]


def correlation_table(folders):
    text = ["| from, to strain | inner grains | of one mode then | of one mode always | paper, finite elements | "
            "paper, experiment |", "|---|---|---|---|---|---|"]
    before = 0.42
    for strain, (elements, experiment) in paper_correlation.items():
        mine = []
        for folder in folders:
            x, y = spreads_at(folder, before), spreads_at(folder, strain)
            grains = sorted(set(x) & set(y))
            if grains:
                mine.append(f"{correlation([x[g] for g in grains], [y[g] for g in grains]):.2f}")
        if len(mine) == len(folders):
            text.append(f"| {before}, {strain} | {' | '.join(mine)} | {elements} | {experiment} |")
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
        line("Taylor has less brass", brass[1] < brass[0],
             f"{brass[1]:.2f} against {brass[0]:.2f}; over copper {brass[1] / copper[1]:.2f} against "
             f"{brass[0] / copper[0]:.2f}")]


def copy_figures(run, folder):
    """The analysis' figures that the page shows, into `folder`; their names."""
    os.makedirs(folder, exist_ok=True)
    analysis = os.path.join(run, "analysis")
    figures = ["compare-odf-rodrigues.svg", "compare-pole-figures.svg", "compare-components.svg",
               "compare-beta-fibre.svg", "compare-stress.svg", "spread-distribution.svg",
               "spread-correlation.svg", "rotation-paths.svg"]
    figures += sorted(f for f in os.listdir(analysis) if f.startswith("grain-"))
    there = [f for f in figures if os.path.exists(os.path.join(analysis, f))]
    for figure in there:
        shutil.copy(os.path.join(analysis, figure), folder)
    return there


def main(run, one_mode, always, page, name):
    with open(os.path.join(run, "summary.json")) as file:
        summary = json.load(file)
    figures = copy_figures(run, os.path.join(os.path.dirname(os.path.abspath(page)), "aluminium"))
    grains, elements = summary["grains"], summary["elements_initial"]
    folders = [run, one_mode, always]
    inner, one, ever = (len(spreads_at(folder, summary["final_strain"])) for folder in folders)
    remeshings = ", ".join(f"{r['strain']:.4g}" for r in summary["remeshings"]) or "no strain"
    text = [f"# {name}: the paper's findings",
            "", "Written by `scripts/texture`; do not edit.", "",
            f"{grains} grains, {elements} elements at first ({elements / grains:.0f} a grain), "
            f"{summary['elements_final']} at last, to strain {summary['final_strain']:.4g}, remeshed at "
            f"{remeshings}; {summary['steps']} steps, {sum(summary['cpu_s'].values()):.0f} s of CPU. "
            f"Textures of all grains and of the Taylor model of their initial orientations, spreads of the {inner} "
            f"inner grains, of the {one} of them that have one mode at the three strains below and of the {ever} that have "
            "one mode at every stored strain: the paper's fig. 20 has grains of one mode only, by a definition of its "
            "own. Definitions: [texture.md](texture.md).", "", "## Textures", ""]
    text += findings(run) + [""] + texture_table(run)
    text += ["", "## In-grain spreads", "", "Means over grains, with the standard error of their scatter.", ""]
    text += spread_table(folders) + growth(folders) + [""] + correlation_table(folders)
    text += ["", "Of all inner grains the spreads are larger than the paper's and hang together more firmly; of those "
             "of one mode, which fig. 20 has, they are nearer. A mesh resolves only a part of a spread, so that a mean "
             "is one of a mesh, too: with 100 elements a grain the mixed element of this run finds about three "
             "quarters of what fine meshes tend to, a displacement element two thirds. "
             "[What a spread depends on](texture.md#what-a-spread-depends-on) has the measurements.", "",
             "## Figures", ""]
    text += [f"![{figure[:-4]}](aluminium/{figure})\n" for figure in figures]
    with open(page, "w") as out:
        out.write("\n".join(text))


if __name__ == "__main__":
    if len(sys.argv) != 6:
        sys.exit(__doc__)
    main(*sys.argv[1:])
