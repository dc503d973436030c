#!/usr/bin/python3
"""browser_test.py POLYSLIP: the report of a small run in headless Chromium.

What the page shows is held against what the run left: macro.csv, summary.json, and tables that
`polyslip convert` writes of the stored states.
"""

import csv
import json
import math
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

DECK = """[polycrystal]
grains = 8
seed = 1
[mesh]
element_size = 0.8
meshers = ["gmsh-hxt"]
[loading]
final_strain = 0.06
max_strain_increment = 0.01
[remeshing]
at_strains = [0.03]
[output]
at_strains = [0.02]
"""

FLAGS = ("--headless=new --no-sandbox --disable-quic --no-first-run --disable-background-networking "
         "--disable-component-update --disable-sync --window-size=1280,950 --force-prefers-reduced-motion").split()
SOFTWARE_GL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
NO_GL = ["--disable-gpu", "--disable-3d-apis"]

polyslip = sys.argv.pop(1)


def numbers(path):
    with open(path) as file:
        return [{name: float(text) for name, text in row.items()} for row in csv.DictReader(file)]


def von_mises(row):
    normal = ((row["sxx"] - row["syy"]) ** 2 + (row["syy"] - row["szz"]) ** 2
              + (row["szz"] - row["sxx"]) ** 2) / 2
    return math.sqrt(normal + 3 * (row["syz"] ** 2 + row["szx"] ** 2 + row["sxy"] ** 2))


class Browser:
    """A page in a browser that has never run before."""

    def __init__(self, page, flags):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for flag in [*FLAGS, *flags, "--user-data-dir=" + self.profile.name]:
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.driver.get(page.as_uri())
        self.wait("document.documentElement.dataset.ready === 'yes'")

    def close(self):
        self.driver.quit()
        self.profile.cleanup()

    def ask(self, expression, *arguments):
        return self.driver.execute_script("return " + expression, *arguments)

    def wait(self, condition):
        end = time.time() + 60
        while not self.ask(condition):
            if time.time() > end:
                raise AssertionError(f"in vain: {condition}; console: {self.console()}")
            time.sleep(0.05)

    def console(self):
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def text(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector).text

    def choose(self, name, value):
        self.driver.execute_script(
            "const e = document.querySelector(`[name=${arguments[0]}]`); e.value = arguments[1];"
            "e.dispatchEvent(new Event('input', { bubbles: true }))", name, value)

    def picture(self):
        """What the view shows: its number of colours and a text that differs if pictures do."""
        return self.ask("""(() => {
          const from = document.querySelector('.view canvas');
          const to = document.createElement('canvas');
          [to.width, to.height] = [from.width, from.height];
          const context = to.getContext('2d');
          context.drawImage(from, 0, 0);
          const bytes = new Uint32Array(context.getImageData(0, 0, to.width, to.height).data.buffer);
          return { colours: new Set(bytes).size, text: to.toDataURL() };
        })()""")


def program(*arguments):
    subprocess.run([polyslip, *arguments], check=True, stdout=subprocess.DEVNULL)


def setUpModule():
    """One run for all tests: FOLDER/small, of FOLDER/small.toml."""
    global FOLDER
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    FOLDER = Path(folder.name)
    (FOLDER / "small.toml").write_text(DECK)
    program("run", FOLDER / "small.toml", "--out", FOLDER / "small")


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.run_folder = FOLDER / "small"
        cls.summary = json.loads((cls.run_folder / "summary.json").read_text())
        cls.macro = numbers(cls.run_folder / "macro.csv")
        cls.index = json.loads((cls.run_folder / "results/index.json").read_text())["states"]
        cls.page = cls.run_folder / "report.html"
        cls.browser = Browser(cls.page, SOFTWARE_GL)
        cls.addClassCleanup(cls.browser.close)

    def elements_at(self, strain):
        table = self.run_folder / "state.csv"
        program("convert", self.run_folder, "--at-strain", str(strain), "--to", table)
        return numbers(table)

    def go_to(self, state):
        """Moves the slider by the keyboard, as a reader may."""
        slider = self.browser.driver.find_element(By.ID, "state")
        slider.send_keys(Keys.HOME, *[Keys.ARROW_RIGHT] * state)
        self.browser.wait(f"document.querySelector('.view').dataset.state === '{state}'")

    def shown_means(self):
        rows = self.browser.driver.find_elements(By.CSS_SELECTOR, "#state-numbers tbody tr")
        cells = [[cell.text for cell in row.find_elements(By.TAG_NAME, "td")] for row in rows]
        return {name: float(value.split()[0].rstrip("°")) for name, value in cells}

    def test_headline_is_the_summary(self):
        tiles = self.browser.text(".tiles")
        for text in ("8\ngrains", "0.06\nfinal strain", "1\nremeshings",
                     f"{self.summary['elements_final']}\nelements, {self.summary['elements_initial']} at first",
                     f"{self.summary['steps']}\nsteps"):
            self.assertIn(text, tiles)
        self.assertIn("8 grains", self.browser.text("#subtitle"))

    def test_curves_are_those_of_macro_csv(self):
        load, mises = self.browser.ask(
            "[0, 1].map((i) => document.querySelector('#stress-strain .plot').data[i])"
            ".map(({ x, y }) => ({ x, y }))")
        # Pieces from zero stress, with a gap at the remeshing.
        expected = [(0, 0)]
        for i, row in enumerate(self.macro):
            if row["remeshed"]:
                expected += [(None, None), (self.macro[i - 1]["strain"], 0)]
            expected.append((row["strain"], row["load_stress"]))
        self.assertEqual(list(zip(load["x"], load["y"])), expected)
        self.assertEqual(sum(x is None for x in load["x"]), 1)
        self.assertAlmostEqual(mises["y"][-1], von_mises(self.macro[-1]), places=9)
        linear, newton = self.browser.ask(
            "document.querySelector('#iterations .plot').data.map((line) => line.y)")
        self.assertEqual(linear, [row["linear_iterations"] for row in self.macro])
        self.assertEqual(newton, [row["newton_iterations"] for row in self.macro])

    def test_texture_is_that_of_polyslip_analyse(self):
        to = self.run_folder.parent / "analysis"
        program("analyse", self.run_folder, "--to", to)
        with open(to / "texture.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len({row["strain"] for row in rows}), 4)
        lines = self.browser.ask("document.querySelector('#components-intensity .plot').data"
                                 ".map(({ legendgroup, x, y }) => [legendgroup, x, y])")
        for name, strains, intensities in lines:
            expected = [row for row in rows if row["component"] == name]
            self.assertEqual(strains, [float(row["strain"]) for row in expected])
            for shown, row in zip(intensities, expected):
                self.assertAlmostEqual(shown, float(row["intensity"]), delta=1e-9)
        # The pole figures of the last state are those of its file.
        with open(to / "analysis/pole-figures-0.06.csv") as file:
            poles = [row for row in csv.DictReader(file) if row["figure"] == "111"]
        self.assertGreater(len(poles), 1000)
        shown = self.browser.ask("(({ x, y, z }) => ({ x, y, z }))(document.querySelector('#pole-figures .plot').data[0])")
        places = {(round(x, 9), round(y, 9)): z for y, row in zip(shown["y"], shown["z"])
                  for x, z in zip(shown["x"], row)}
        for row in poles:
            z = places[round(float(row["x"]), 9), round(float(row["y"]), 9)]
            self.assertAlmostEqual(z, float(row["density"]), delta=1e-5 * (1 + z))

    def test_spreads_are_those_of_polyslip_analyse(self):
        rows = numbers(self.run_folder / "figures/spread-summary.csv")
        shown = self.browser.ask("(({ x, y }) => ({ x, y }))(document.querySelector('#grain-spreads .plot').data.at(-1))")
        self.assertEqual(shown["x"], [row["strain"] for row in rows])
        self.assertEqual(shown["y"], [row["mean"] for row in rows])
        self.assertGreater(shown["y"][-1], 0.1)
        r = self.browser.ask("document.querySelector('#spread-correlation .plot').layout.annotations[0].text")
        self.assertEqual(r, f"r = {rows[-1]['correlation']:.3g}")

    def test_counts_only_grains_of_one_mode_when_asked(self):
        to = self.run_folder.parent / "one-mode"
        program("analyse", self.run_folder, "--one-mode", "--to", to)
        rows = numbers(to / "analysis/spread-summary.csv")
        self.assertLess(rows[-1]["grains"], 8)
        mean = "(({ x, y }) => ({ x, y }))(document.querySelector('#grain-spreads .plot').data.at(-1))"
        before = self.browser.ask(mean)
        choose = ("const e = document.querySelector('#grain-spreads select'); e.value = [...e.options].findIndex("
                  "(o) => o.text === arguments[0]); e.dispatchEvent(new Event('input', { bubbles: true }))")
        self.browser.driver.execute_script(choose, "of one mode")
        self.browser.wait(f"document.querySelector('#grain-spreads .plot').data.at(-1).y.at(-1) !== {before['y'][-1]!r}")
        for shown, row in zip(self.browser.ask(mean)["y"], rows):
            self.assertAlmostEqual(shown, row["mean"], delta=1e-9)
        self.browser.driver.execute_script(choose, "all grains")
        self.browser.wait(f"document.querySelector('#grain-spreads .plot').data.at(-1).y.at(-1) === {before['y'][-1]!r}")

    def test_rodrigues_sections_are_those_of_their_file(self):
        rows = numbers(self.run_folder / "figures/odf-rodrigues-0.06.csv")
        maps = self.browser.ask("document.querySelector('#odf-rodrigues .plot').data.map(({ x, y, z }) => ({ x, y, z }))")
        self.assertEqual(len(maps), 7)
        heights = sorted({row["r3"] for row in rows})
        self.assertEqual(len(heights), 7)
        for shown, r3 in zip(maps, heights):
            places = {(round(x, 6), round(y, 6)): z for y, line in zip(shown["y"], shown["z"])
                      for x, z in zip(shown["x"], line)}
            section = [row for row in rows if row["r3"] == r3]
            self.assertGreater(len(section), 100)
            for row in section:
                z = places[round(row["r1"], 6), round(row["r2"], 6)]
                self.assertAlmostEqual(z, row["density"], delta=1e-5 * (1 + z))

    def test_grains_are_drawn(self):
        rows = [row for row in numbers(self.run_folder / "figures/spreads.csv") if row["strain"] == 0.06]
        grain = max(rows, key=lambda row: row["volume"])
        maps, lines = self.browser.ask(
            "[['contour'], ['scatter']].map(([type]) => document.querySelector('#rotation-paths .plot').data"
            ".filter((trace) => (trace.type ?? 'scatter') === type).length)")
        self.assertEqual(maps, 2)
        self.assertGreaterEqual(lines, 16)  # four axes of two grains, each with a dot
        title = self.browser.ask("document.querySelector('#rotation-paths .plot').layout.annotations[0].text")
        self.assertIn(f"grain {grain['grain']:.0f}: ", title)
        shown = self.browser.ask("(({ x, y }) => ({ x, y }))(document.querySelector('#grain-orientations .plot').data[0])")
        z = self.browser.ask("document.querySelector('#grain-orientations .plot').data[1].y")
        angles = [math.sqrt(a * a + b * b + c * c) for a, b, c in zip(shown["x"], shown["y"], z)]
        self.assertEqual(len(angles), grain["elements"])
        self.assertAlmostEqual(max(angles), grain["largest"], delta=1e-5)

    def test_figures_are_files_too(self):
        names = {path.name for path in (self.run_folder / "figures").iterdir()}
        for stem in ("stress-strain", "steps", "means", "mesh-quality", "beta-fibre", "pole-figures-0.06",
                     "inverse-pole-figures-0.06", "odf-sections-0.06", "odf-rodrigues-0.06"):
            for extension in (".svg", ".csv"):
                self.assertIn(stem + extension, names)
        self.assertIn("rotation-paths.svg", names)
        self.assertEqual(len([name for name in names if name.startswith("grain-")]), 2)
        rows = numbers(self.run_folder / "figures/stress-strain.csv")
        self.assertEqual([row["strain"] for row in rows], [row["strain"] for row in self.macro])

    def test_remeshing_is_audited(self):
        text = self.browser.text("#audit")
        remeshing = self.summary["remeshings"][0]
        for key in ("elements_before", "elements_after"):
            self.assertIn(str(remeshing[key]), text)
        self.assertIn(f"{remeshing['min_radius_ratio_after']:.3g}", text)

    def test_slider_shows_the_means_of_each_state(self):
        self.assertEqual([state["strain"] for state in self.index], [0, 0.02, 0.03, 0.03, 0.06])
        pictures = set()
        for i, state in enumerate(self.index):
            self.go_to(i)
            text = self.browser.text("#state-text")
            self.assertIn(f"Strain {state['strain']:g}", text)
            self.assertIn(f"{state['elements']} elements", text)
            self.assertIn(state["file"], text)
            picture = self.browser.picture()
            self.assertGreater(picture["colours"], 50)
            pictures.add(picture["text"])
            if i == 3:
                continue  # of two states at one strain convert reads the first
            rows = self.elements_at(state["strain"])
            volume = sum(row["volume"] for row in rows)
            mean = lambda value: sum(row["volume"] * value(row) for row in rows) / volume
            shown = self.shown_means()
            for name, value in {"slip resistance g": mean(lambda row: row["g"]),
                                "accumulated slip": mean(lambda row: row["slip"]),
                                "equivalent plastic strain": mean(lambda row: row["equivalent_strain"]),
                                "von Mises stress": mean(von_mises),
                                "pressure": mean(lambda row: row["pressure"])}.items():
                self.assertAlmostEqual(shown[name], value, delta=6e-4 * abs(value), msg=name)
        self.assertEqual(len(pictures), len(self.index))
        self.assertIn("Strain 0.03, after the remeshing: mesh 2", self.text_at(3))
        self.assertIn("Strain 0.03, before the remeshing: mesh 1", self.text_at(2))

    def text_at(self, state):
        self.go_to(state)
        return self.browser.text("#state-text")

    def test_mouse_tells_the_value_of_an_element(self):
        self.go_to(len(self.index) - 1)
        rows = self.elements_at(0.06)
        view = self.browser.driver.find_element(By.CSS_SELECTOR, ".view canvas")
        for mode, column, label in (("g", "g", "slip resistance g: "), ("pressure", "pressure", "pressure: ")):
            self.browser.choose("mode", mode)
            ActionChains(self.browser.driver).move_to_element_with_offset(view, 20, -10).perform()
            self.browser.wait("document.querySelector('.tip').hidden === false")
            tip = self.browser.text(".tip")
            ActionChains(self.browser.driver).move_to_element_with_offset(view, 0, 0).perform()
            grain = int(tip.split("Grain ")[1].split(",")[0])
            value = float(tip.split(label)[1].split()[0])
            values = [row[column] for row in rows if row["grain"] == grain]
            self.assertLess(min(abs(v - value) for v in values), 6e-3 * abs(value) + 1e-3, tip)

    def test_choices_change_the_picture(self):
        self.go_to(0)
        pictures = [self.browser.picture()["text"]]
        for name, value in (("mode", "ipf2"), ("mode", "grain"), ("edges", "wires"), ("edges", "grains"),
                            ("cut", "2"), ("depth", "30")):
            self.browser.choose(name, value)
            self.browser.wait("document.querySelector('.view').dataset.state === '0'")
            time.sleep(0.2)
            pictures.append(self.browser.picture()["text"])
        self.assertEqual(len(set(pictures)), len(pictures))
        for name, value in (("mode", "rodrigues"), ("edges", "elements"), ("cut", "none")):
            self.browser.choose(name, value)

    def test_light_and_dark(self):
        ground = "getComputedStyle(document.body).backgroundColor"
        ink = "document.querySelector('#iterations .plot').layout.font.color"
        before = self.browser.ask(ground), self.browser.ask(ink)
        self.browser.driver.find_element(By.ID, "theme").click()
        after = self.browser.ask(ground), self.browser.ask(ink)
        self.browser.driver.find_element(By.ID, "theme").click()
        self.assertNotEqual(before[0], after[0])
        self.assertNotEqual(before[1], after[1])

    def test_deck_and_licences_are_there(self):
        self.assertIn(DECK.strip(), self.browser.ask("document.querySelector('#origin pre').textContent"))
        self.assertIn("three", self.browser.ask("document.querySelector('footer pre').textContent"))
        self.assertIn("MIT", self.browser.ask("document.querySelector('footer pre').textContent"))

    def test_says_so_without_webgl(self):
        browser = Browser(self.page, NO_GL)
        self.addCleanup(browser.close)
        self.assertIn("no WebGL", browser.text("#no-webgl"))
        self.assertIn("8\ngrains", browser.text(".tiles"))
        self.assertGreater(browser.ask("document.querySelectorAll('.plot .main-svg').length"), 3)
        self.assertEqual(browser.console(), [])

    def test_zz_asked_nothing_of_the_network_and_left_the_console_clean(self):
        self.assertEqual(self.browser.ask("performance.getEntriesByType('resource').length"), 0)
        self.assertEqual(self.browser.console(), [])


class ReportBesideTaylor(unittest.TestCase):
    """The same run with the Taylor model of its deck."""

    @classmethod
    def setUpClass(cls):
        cls.taylor = FOLDER / "taylor"
        program("taylor", FOLDER / "small.toml", "--out", cls.taylor)
        program("analyse", cls.taylor)
        cls.run_folder = FOLDER / "beside"
        shutil.copytree(FOLDER / "small", cls.run_folder, ignore=shutil.ignore_patterns("report.html", "figures"))
        program("report", cls.run_folder, "--taylor", cls.taylor)
        cls.browser = Browser(cls.run_folder / "report.html", NO_GL)
        cls.addClassCleanup(cls.browser.close)

    def test_components_are_those_of_both(self):
        with open(self.taylor / "texture.csv") as file:
            rows = list(csv.DictReader(file))
        lines = self.browser.ask("document.querySelector('#components-intensity .plot').data"
                                 ".map(({ legendgroup, line, x, y }) => [legendgroup, line.dash, x, y])")
        dashed = [line for line in lines if line[1] == "dash"]
        self.assertEqual(2 * len(dashed), len(lines))
        for name, _, strains, intensities in dashed:
            expected = [row for row in rows if row["component"] == name]
            self.assertGreater(len(expected), 2)
            self.assertEqual(strains, [float(row["strain"]) for row in expected])
            for shown, row in zip(intensities, expected):
                self.assertAlmostEqual(shown, float(row["intensity"]), delta=1e-9)
        mine = next(line[3] for line in lines if line[:2] == [dashed[0][0], "solid"])
        self.assertNotAlmostEqual(mine[-1], dashed[0][3][-1], delta=1e-3)

    def test_maps_stand_below_those_of_the_run(self):
        for name, count in (("pole-figures", 3), ("inverse-pole-figures", 3), ("odf-sections", 3), ("odf-rodrigues", 7)):
            titles = self.browser.ask(f"document.querySelector('#{name} .plot').layout.annotations.map((a) => a.text)")
            for whose in ("run", "Taylor"):
                self.assertEqual(sum(f", {whose}, strain 0.06" in title for title in titles), count, name)
            maps = self.browser.ask(f"document.querySelector('#{name} .plot').data.filter((d) => d.type === 'contour').length")
            self.assertEqual(maps, 2 * count)
        with open(self.taylor / "analysis/pole-figures-0.06.csv") as file:
            poles = [row for row in csv.DictReader(file) if row["figure"] == "111"]
        shown = self.browser.ask("(({ x, y, z }) => ({ x, y, z }))(document.querySelector('#pole-figures .plot').data[3])")
        places = {(round(x, 9), round(y, 9)): z for y, row in zip(shown["y"], shown["z"])
                  for x, z in zip(shown["x"], row)}
        for row in poles:
            z = places[round(float(row["x"]), 9), round(float(row["y"]), 9)]
            self.assertAlmostEqual(z, float(row["density"]), delta=1e-5 * (1 + z))

    def test_curves_index_and_fibre_have_both(self):
        stress = numbers(self.taylor / "macro.csv")
        lines = self.browser.ask("document.querySelector('#stress-strain .plot').data.map(({ name, y }) => [name, y])")
        taylor = [y for name, y in lines if "Taylor" in name]
        self.assertEqual(taylor[0], [row["load_stress"] for row in stress])
        self.assertAlmostEqual(taylor[1][-1], von_mises(stress[-1]), places=9)
        self.assertEqual(self.browser.ask("document.querySelector('#texture-index .plot').data.map((d) => d.name)"),
                         ["run", "Taylor"])
        self.assertEqual(self.browser.ask("document.querySelector('#beta-fibre .plot').data.length"), 4)

    def test_zz_console_is_clean(self):
        self.assertEqual(self.browser.console(), [])


if __name__ == "__main__":
    unittest.main()
