"""What type checkers are told of the module is what there is."""
import ast
import re
import unittest
from pathlib import Path

import duoptic

STUBS = ast.parse((Path(duoptic.__file__).parent / "__init__.pyi").read_text())
CLASSES = {node.name: node for node in STUBS.body if isinstance(node, ast.ClassDef)}
FUNCTIONS = {node.name: node for node in STUBS.body if isinstance(node, ast.FunctionDef)}


def options_of(name):
    """The keywords of a dictionary of options, those of its bases among them."""
    node = CLASSES[name]
    own = {line.target.id for line in node.body if isinstance(line, ast.AnnAssign)}
    return own.union(*(options_of(base.id) for base in node.bases if base.id in CLASSES))


class Stubs(unittest.TestCase):
    def test_every_name_and_no_other(self):
        told = {name for name in [*CLASSES, *FUNCTIONS] if not name.startswith("_")}
        self.assertEqual(told, set(duoptic.__all__))
        for name in told & set(CLASSES) - {"Error"}:
            members = {node.name for node in CLASSES[name].body if isinstance(node, ast.FunctionDef)}
            there = {member for member in vars(getattr(duoptic, name)) if not member.startswith("_")}
            self.assertEqual({member for member in members if not member.startswith("_")}, there, name)
            for member in members:
                self.assertTrue(hasattr(getattr(duoptic, name), member), f"{name}.{member}")

    def test_options_are_those_of_the_docstrings(self):
        for name, options in (("open", "_OpenOptions"), ("record", "_RecordOptions")):
            signature = re.search(rf"{name}\(.*?\*, (.*?)\) ->", getattr(duoptic, name).__doc__, re.DOTALL)[1]
            self.assertEqual(set(re.findall(r"(\w+)=", signature)), options_of(options), name)
        for option in options_of("_EngineOptions"):  # each is known, whatever it says of the value
            with self.assertRaises((duoptic.Error, TypeError)) as raised:
                duoptic.Engine((320, 240), **{option: object()})
            self.assertNotIn("unexpected keyword", str(raised.exception))


if __name__ == "__main__":
    unittest.main()
