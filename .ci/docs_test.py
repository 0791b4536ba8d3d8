"""Tests docs.py, questions.py and package/site_links.py: each finds the faults that are planted here, and nothing else."""
import importlib.util
import pathlib
import tempfile
import unittest

HERE = pathlib.Path(__file__).parent


def load(path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


docs = load(HERE / "docs.py")
questions = load(HERE / "questions.py")
site_links = load(HERE / "package" / "site_links.py")


class Pages(unittest.TestCase):
    def faults(self, **changes):
        """The faults of a small documentation with changed files; `None` removes a file."""
        files = {
            "mkdocs.yml": "nav:\n  - index.md\n  - Learn:\n      - learn/index.md\n      - learn/first.md\n",
            "docs/index.md": "# Home\n\n[Learn](learn/index.md)\n",
            "docs/learn/index.md": "# Learn\n\n[First](first.md#the-end)\n",
            "docs/learn/first.md": "# First\n\n## The end\n\n" + "x" * 120 + "\n",
        } | changes
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                if text is None:
                    continue
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            return list(docs.faults(root))

    def expect(self, fragment, **changes):
        found = self.faults(**changes)
        self.assertEqual(len(found), 1, found)
        self.assertIn(fragment, found[0])

    def test_accepts_good_pages(self):
        self.assertEqual(self.faults(), [])

    def test_reports_wide_lines(self):
        wide = "# First\n\n## The end\n\n" + "ä" * 121 + "\n"
        self.expect("first.md:5: 121 columns", **{"docs/learn/first.md": wide})
        table = "# First\n\n## The end\n<!-- made by hand -->\n|" + "a" * 150 + "|\n"
        self.assertEqual(self.faults(**{"docs/learn/first.md": table}), [])
        self.expect("columns", **{"docs/learn/first.md": table.replace("<!--", "")})

    def test_reports_long_pages(self):
        self.expect("401 lines", **{"docs/learn/first.md": "# First\n\n## The end\n" + "x\n" * 398})
        self.assertEqual(self.faults(**{"docs/learn/first.md": "# First\n\n## The end\n" + "x\n" * 397}), [])

    def test_reports_large_cells(self):
        text = "# First\n\n## The end\n<!-- made by hand -->\n| a | " + "b" * 1000 + " |\n"
        self.expect("a cell of", **{"docs/learn/first.md": text})

    def test_reports_broken_links(self):
        self.expect("there is no second.md", **{"docs/index.md": "[Learn](learn/index.md)\n[x](second.md)\n"})
        page = "[Learn](learn/index.md)\n[x](learn/first.md#the-start)\n"
        self.expect("has no #the-start", **{"docs/index.md": page})

    def test_reports_pages_without_navigation(self):
        found = self.faults(**{"docs/learn/second.md": "# Second\n"})
        self.assertEqual(len(found), 2, found)
        self.assertIn("navigation", found[0])
        self.assertIn("index.md has no link", found[1])


class Questions(unittest.TestCase):
    def faults(self, item):
        """The faults of a list of thirty good questions and this item."""
        good = "".join(f"- Question {i}?\n  [first](first.md#the-end)\n" for i in range(30))
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "first.md").write_text("# First\n\n## Empty\n\n## The end\n\nText.\n", encoding="utf-8")
            (root / "questions.md").write_text("# Questions\n\n" + good + item, encoding="utf-8")
            return [text for _, text in questions.findings(root)]

    def test_accepts_good_lists(self):
        self.assertEqual(self.faults("- One more?\n  [first](first.md#first)\n"), [])

    def test_reports_missing_answers(self):
        for item, text in [
            ("- One more?\n  [second](second.md#first)\n", "page docs/second.md not found"),
            ("- One more?\n  [first](first.md#begin)\n", "has no heading 'begin'"),
            ("- One more?\n  [first](first.md#empty)\n", "no text under the heading 'empty'"),
            ("- One more?\n", "below the question"),
            ("- Question 1?\n  [first](first.md#first)\n", "is also in line"),
        ]:
            found = self.faults(item)
            self.assertEqual(len(found), 1, found)
            self.assertIn(text, found[0])


class Site(unittest.TestCase):
    def faults(self, page="", **files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            page = f'<html><body><h1 id="top">T</h1>{page}</body></html>'
            all_files = {
                "docs/index.md": "",
                "site/index.html": page,
                "site/search/lunr.js": "",
                "site/search/search_index.js": 'const limberPages = [{"text":"fetch(\'https://a.b\')"}];\n',
            } | files
            for name, text in all_files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            return site_links.faults(root / "site", root / "docs")

    def test_accepts_good_sites(self):
        page = ('<a href="https://a.b/">other</a> <a href="#top">up</a> <img src="data:image/png;base64,AA">'
                '<a href="mailto:a@b.c">mail</a> <svg xmlns="http://www.w3.org/2000/svg"></svg>'
                '<p>fetch("https://a.b/")</p>')
        css = "/* url(https://a.b) */ p { background: url(data:image/png;base64,AA); }"
        script = "// https://a.b\nconst s = document.createElement('script'); s.src = `${base}/search/lunr.js`;"
        self.assertEqual(self.faults(page, **{"site/a.css": css, "site/a.js": script}), [])

    def test_reports_other_hosts(self):
        for page in (
            '<img src="https://a.b/c.png">', '<img srcset="x.png 1x, //a.b/c.png 2x">',
            '<script src="//a.b/c.js"></script>', '<link rel="stylesheet" href="https://a.b/c.css">',
            '<link rel="preconnect" href="https://a.b">', '<iframe src="https://a.b"></iframe>',
            '<form action="https://a.b"></form>', '<a ping="https://a.b" href="#top">x</a>',
            '<p style="background: url(https://a.b/c.png)">x</p>', "<style>@import 'https://a.b/c.css';</style>",
            '<style>p { src: url("//a.b/font.woff2") }</style>', "<script>fetch('x.json')</script>",
            "<script>new XMLHttpRequest()</script>", "<script>import('./x.js')</script>",
            "<script>image.src = 'https://a.b/c.png'</script>", '<p onclick="fetch(1)">x</p>',
            '<meta http-equiv="refresh" content="0; url=https://a.b">', '<video poster="https://a.b/c.png"></video>',
            '<a href="javascript:alert(1)">x</a>', '<svg><use xlink:href="https://a.b/c.svg"></use></svg>',
        ):
            with self.subTest(page=page):
                self.assertNotEqual(self.faults(page), [])
        self.assertNotEqual(self.faults(**{"site/a.css": "@import url(https://a.b/c.css);"}), [])
        self.assertNotEqual(self.faults(**{"site/a.js": "const w = new WebSocket(address);"}), [])
        self.assertNotEqual(self.faults(**{"site/a.svg": '<svg><image href="https://a.b/c.png"/></svg>'}), [])

    def test_reports_missing_targets(self):
        for page in ('<a href="other.html">x</a>', '<a href="#bottom">x</a>', '<img src="x.png">',
                     '<a href="../docs/index.md">x</a>'):
            with self.subTest(page=page):
                self.assertEqual(len(self.faults(page)), 1)

    def test_reports_pages_that_were_not_built(self):
        self.assertEqual(len(self.faults(**{"docs/learn/first.md": "# First\n"})), 1)


if __name__ == "__main__":
    unittest.main()
