"""Keywords stand in the stubs as the library describes them, and docstrings list them."""

import ast
import pathlib
import unittest

from support import main, pp

STUBS = pathlib.Path(pp.__file__).with_suffix(".pyi")
# The structs of options that a function takes, and what of them it has no use for: the depth filter's choice is
# nothing to clouds, the clouds' choice nothing to depth images, and a contact that is set keeps its proxy's method.
FUNCTIONS = {
    "prepare": (["PrepareOptions"], set()),
    "Scene.add": (["PrepareOptions"], set()),
    "Scene.add_stream": (["PolicyOptions", "PrepareOptions"], {"fit_everywhere"}),
    "Scene.add_camera": (["PolicyOptions", "DepthFilterOptions"], {"clip_to_reach"}),
    "Field.__init__": (["FieldOptions"], set()),
    "Proxy.__init__": (["ProxyOptions"], set()),
    "Servo.__init__": (["FieldOptions", "ProxyOptions", "GuardOptions"], set()),
    "Servo.set_contact": (["ProxyOptions"], {"method", "max_iterations", "tangent_tolerance", "rise_time"}),
}


def stubs():
    """The keywords of each function of the stubs, with their types, aliases replaced by what they stand for."""
    tree = ast.parse(STUBS.read_text(encoding="utf-8"))
    aliases = {node.targets[0].id: ast.unparse(node.value) for node in tree.body
               if isinstance(node, ast.Assign) and ast.unparse(node.value).startswith("Literal")}
    functions = {}
    for node in tree.body:
        within = node.body if isinstance(node, ast.ClassDef) else [node]
        for each in within:
            if isinstance(each, ast.FunctionDef):
                name = f"{node.name}.{each.name}" if each is not node else each.name
                types = {argument.arg: ast.unparse(argument.annotation) for argument in each.args.kwonlyargs}
                functions[name] = {key: aliases.get(text, text) for key, text in types.items()}
    return functions


class Keywords(unittest.TestCase):
    def setUp(self):
        self.described = pp._palpate._keywords()

    def test_stubs_have_them_with_their_types(self):
        functions = stubs()
        for name, (structs, needless) in FUNCTIONS.items():
            wanted = {key: text for struct in structs for key, text in self.described[struct].items() if key not in needless}
            there = {key: text for key, text in functions[name].items() if key in wanted}
            self.assertEqual(there, wanted, name)

    def test_all_structs_are_compared(self):
        self.assertEqual({struct for structs, _ in FUNCTIONS.values() for struct in structs}, set(self.described))

    def test_docstrings_list_them(self):
        for text, struct in ((pp.prepare.__doc__, "PrepareOptions"), (pp.Scene.add_stream.__doc__, "PolicyOptions"),
                             (pp.Scene.add_camera.__doc__, "DepthFilterOptions"), (pp.Field.__doc__, "FieldOptions"),
                             (pp.Proxy.__doc__, "ProxyOptions"), (pp.Servo.__doc__, "GuardOptions")):
            for key in self.described[struct]:
                self.assertIn(key, text)

    def test_a_choice_is_taken_by_its_name(self):
        scene = pp.Scene()
        with self.assertRaisesRegex(pp.Error, "policy .*'last'.*replace, average, crossfade, morph"):
            scene.add_stream("a", policy="last")
        scene.add_stream("a", policy="average", fade=0.2)

    def test_a_number_out_of_its_range_is_refused_by_its_name(self):
        with self.assertRaisesRegex(pp.Error, r"policy: fade \(s\) is -1; give a number above 0"):
            pp.Scene().add_stream("a", fade=-1)
        with self.assertRaisesRegex(pp.Error, r"proxy: friction\.static is -0\.1; give"):
            pp.Proxy(friction_static=-0.1)


main()
