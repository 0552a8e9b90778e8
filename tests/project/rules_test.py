"""Each rule must find what it is there to find."""

import pathlib
import tempfile
import unittest

import rules


class Rules(unittest.TestCase):
    def found(self, rule, files):
        """What a rule says of a tree with these files."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                path = root / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            return list(rule(root))

    def test_an_include_that_points_up_is_found(self):
        up = '#include "palpate/scene/scene.hpp"\n'
        self.assertEqual(len(self.found(rules.floors, {"src/geometry/a.cpp": up})), 1)
        self.assertEqual(len(self.found(rules.floors, {"include/palpate/field/a.hpp": up})), 1)
        self.assertEqual(self.found(rules.floors, {"src/device/a.cpp": up}), [])
        self.assertEqual(self.found(rules.floors, {"python/src/a.cpp": up}), [])
        viewer = '#include "palpate/viewer/viewer.hpp"\n'
        self.assertEqual(len(self.found(rules.floors, {"python/src/a.cpp": viewer})), 1)

    def test_an_include_of_a_private_header_above_is_found(self):
        up = '#include "io/input.hpp"\n'
        self.assertEqual(len(self.found(rules.floors, {"src/field/a.cpp": up})), 1)

    def test_contact_sees_one_header_of_field(self):
        self.assertEqual(
            self.found(rules.floors,
                       {"src/contact/a.cpp": '#include "palpate/field/field.hpp"\n'}), [])
        self.assertEqual(
            len(self.found(rules.floors,
                           {"src/contact/a.cpp": '#include "palpate/field/kernel.hpp"\n'})), 1)

    def test_the_core_sees_no_floor_beside_it(self):
        for beside in ("refine/segments", "stream/morph", "large/blocks", "sight/sight", "depth/input",
                       "extras/splats/splat_shell"):
            files = {"src/prepare/a.cpp": f'#include "{beside}.hpp"\n'}
            self.assertEqual(len(self.found(rules.floors, files)), 1, beside)
            self.assertEqual(len(self.found(rules.floors, {"src/scene/a.hpp": files["src/prepare/a.cpp"]})), 1, beside)
        self.assertEqual(
            self.found(rules.floors,
                       {"src/extras/splats/a.cpp": '#include "extras/splats/splat_shell.hpp"\n'}), [])

    def test_a_floor_that_is_not_drawn_above_what_it_sees_is_found(self):
        name = "docs/architecture.md"
        text = (pathlib.Path(rules.__file__).resolve().parents[2] / name).read_text(encoding="utf-8")
        self.assertEqual(self.found(rules.drawn, {name: text}), [])
        line = "sight/  " + text.partition("\nsight/  ")[2].partition("\n")[0] + "\n"
        self.assertEqual(len(self.found(rules.drawn, {name: text.replace(line, "")})), 1, "it is gone")
        up = text.replace(line, "").replace("\nstream/  ", "\n" + line + "stream/  ")
        self.assertEqual(len(self.found(rules.drawn, {name: up})), 1, "stream sees it")

    def test_a_step_of_preparation_sees_earlier_ones_alone(self):
        for step, count in (("radii", 0), ("weights", 1), ("assemble", 1)):
            files = {"src/prepare/plane_fits.hpp": f'#include "prepare/{step}.hpp"\n'}
            self.assertEqual(len(self.found(rules.steps, files)), count, step)
        self.assertEqual(len(self.found(rules.steps, {"src/refine/a.cpp": ""})), 1)

    def test_the_gathering_header_and_the_standard_library_are_free(self):
        files = {"include/palpate/palpate.hpp": '#include "palpate/scene/scene.hpp"\n',
                 "src/base/a.cpp": "#include <vector>\n"}
        self.assertEqual(self.found(rules.floors, files), [])

    def test_a_room_of_the_program_sees_those_below_it_alone(self):
        for line, count in (('#include "apps/palpate/cli/words.hpp"\n', 0),
                            ('#include "apps/palpate/view/view.hpp"\n', 1),
                            ('#include "apps/palpate/attic/view.hpp"\n', 1)):
            files = {"apps/palpate/run/a.cpp": line}
            self.assertEqual(len(self.found(rules.rooms, files)), count, line)
        self.assertEqual(len(self.found(rules.rooms, {"apps/palpate/a.cpp": ""})), 1)
        self.assertEqual(self.found(rules.rooms, {"apps/palpate/main.cpp": ""}), [])

    def test_a_third_party_in_a_public_header_is_found(self):
        name = "include/palpate/io/a.hpp"
        for line in ("#include <fmt/format.h>\n", "#include <zlib.h>\n", '#include "io/b.hpp"\n'):
            self.assertEqual(len(self.found(rules.public_headers, {name: line})), 1, line)
        for line in ("#include <Eigen/Core>\n", "#include <span>\n",
                     '#include "palpate/io/b.hpp"\n'):
            self.assertEqual(self.found(rules.public_headers, {name: line}), [], line)

    def test_macros_are_found(self):
        self.assertEqual(len(self.found(rules.macros, {"src/io/a.cpp": "#define A 1\n"})), 1)
        self.assertEqual(len(self.found(rules.macros, {"src/io/a.cpp": "#ifdef A\n#endif\n"})), 1)
        self.assertEqual(self.found(rules.macros, {"src/base/cpu.hpp": "#if A\n#endif\n"}), [])

    def test_a_remedy_without_a_test_is_found(self):
        told = {"src/io/a.cpp": 'fail("Unpack it: xz -dk FILE");\n', "tests/io/a_test.cpp": "TEST(A, IsUnpacked) {\n"}
        rows = "tests/project/remedies.txt"
        self.assertEqual(len(self.found(rules.remedies, told)), 1)
        self.assertEqual(self.found(rules.remedies, told | {rows: "src/io/a.cpp | xz -dk | A.IsUnpacked\n"}), [])
        self.assertEqual(self.found(rules.remedies, told | {rows: "src/io/a.cpp | xz -dk | not run: no xz\n"}), [])
        self.assertEqual(len(self.found(rules.remedies, told | {rows: "src/io/a.cpp | xz -dk | A.IsGone\n"})), 1)
        self.assertEqual(len(self.found(rules.remedies, {rows: "src/io/a.cpp | xz -dk | A.IsUnpacked\n"} | {"tests/io/a_test.cpp": told["tests/io/a_test.cpp"]})), 1)

    def test_marks_are_found(self):
        mark = "// TO" + "DO: later\n"
        self.assertEqual(len(self.found(rules.marks, {"src/io/a.cpp": mark})), 1)

    def test_long_files_are_found(self):
        self.assertEqual(len(self.found(rules.size, {"src/io/a.cpp": "int a;\n" * 301})), 1)
        self.assertEqual(self.found(rules.size, {"src/io/a.cpp": "int a;\n" * 300}), [])

    def test_long_functions_are_found(self):
        def function(inside):
            return "int f(int a,\n      int b) {\n" + "  ++a;\n" * inside + "}\n"
        self.assertEqual(len(self.found(rules.functions, {"src/io/a.cpp": function(38)})), 1)
        self.assertEqual(self.found(rules.functions, {"src/io/a.cpp": function(37)}), [])

    def test_files_comments_and_constants_speak(self):
        said = "// Adds numbers.\n#include <a>\n"
        self.assertEqual(self.found(rules.purpose, {"src/io/a.cpp": said, "src/io/b.hpp": "#pragma once\n// A sum.\n"}), [])
        self.assertEqual(len(self.found(rules.purpose, {"src/io/a.cpp": "#include <a>\n// A sum.\nint a;\n"})), 1)
        self.assertEqual(len(self.found(rules.riddles, {"src/io/a.cpp": "// Of what is no number.\n"})), 1)
        self.assertEqual(self.found(rules.riddles, {"src/io/a.cpp": "// Number\n// Of things.\n"}), [])
        constant = "constexpr int kMost = 3;"
        self.assertEqual(len(self.found(rules.reasons, {"src/field/a.cpp": f"\n{constant}\n"})), 1)
        self.assertEqual(self.found(rules.reasons, {"src/field/a.cpp": f"\n{constant}  // points\n"}), [])
        self.assertEqual(self.found(rules.reasons, {"src/io/a.cpp": f"\n{constant}\n"}), [])

    def test_a_class_fits_into_one_head(self):
        def of(methods, members):
            return ("class A {\n public:\n" + "  void act();\n" * methods + " private:\n"
                    + "".join(f"  int a{i}_ = 0;\n" for i in range(members)) + "};\n")
        for methods, members, count in ((20, 12, 0), (21, 0, 1), (0, 13, 1)):
            self.assertEqual(len(self.found(rules.classes, {"src/io/a.hpp": of(methods, members)})), count)

    def test_a_struct_that_its_methods_change_is_a_class(self):
        plain = ("  A(int a,\n    int b);\n  bool operator==(const A&) const = default;\n"
                 "  static A made();\n  [[nodiscard]] int sum(std::function<void()> act,\n"
                 "                        int b) const noexcept {\n    return b;\n  }\n")
        for methods, members, count in ((plain, 13, 0), (plain + "  void act();\n", 12, 0),
                                        (plain + "  void act();\n", 13, 1), ("  ~A() { act(); }\n", 13, 1),
                                        ("  A& operator=(int a);\n", 13, 1), ("  void act() const;\n" * 21, 1, 0),
                                        ("  template <class T>\n  void act(T t);\n" * 21, 1, 1)):
            body = methods + "".join(f"  std::array<int, 3> a{i}{{f(1)}};\n" for i in range(members))
            for head, indent, tail in (("struct B::A {\n", "", "};\n"), ("class C {\n  struct A {\n", "  ", "  };\n};\n")):
                text = head + "".join(indent + line + "\n" for line in body.splitlines()) + tail
                self.assertEqual(len(self.found(rules.classes, {"src/io/a.hpp": text})), count, text)

    def test_a_header_that_one_file_reads_is_found(self):
        files = {"src/io/a.hpp": "int a;\n", "src/io/a.cpp": '#include "io/a.hpp"\n',
                 "src/io/b.cpp": '#include "io/a.hpp"\n'}
        self.assertEqual(len(self.found(rules.readers, files)), 1)
        long = {**files, "src/io/b.cpp": files["src/io/b.cpp"] + "int b;\n" * 250}
        self.assertEqual(self.found(rules.readers, long), [])
        tested = {**files, "tests/io/a_test.cpp": '#include "io/a.hpp"\n'}
        self.assertEqual(self.found(rules.readers, tested), [])

    def test_a_test_case_that_asserts_nothing_is_found(self):
        def of(body, kind="TEST"):
            return f"{kind}(A, Holds) {{\n  {body}\n}}\n"
        name, helper = "tests/io/a_test.cpp", "void check(int a,\n           int b) {\n  EXPECT_EQ(a, b);\n}\n"
        for body in ("act();", "// EXPECT_EQ(a, b);", "check(1, 2);", "RC_PRE(a);", "FAILING();"):
            for kind in ("TEST", "TEST_F", "TEST_P", "TYPED_TEST", "RC_GTEST_PROP"):
                self.assertEqual(len(self.found(rules.proving, {name: of(body, kind)})), 1, body)
        for body in ("EXPECT_EQ(a, b);", "ASSERT_TRUE(a);", "RC_ASSERT(a);", "FAIL() << a;", 'ADD_FAILURE_AT("a", 1);'):
            self.assertEqual(self.found(rules.proving, {name: of(body)}), [], body)
        self.assertEqual(self.found(rules.proving, {name: helper + of("check(1, 2);")}), [])
        twice = '#include "io/a.hpp"\n#include "support/a.hpp"\ninline void twice() {\n  check<int>(1, 1);\n}\n'
        for where, count in (("tests/io/a.hpp", 0), ("tests/support/a.cpp", 0), ("tests/io/c_test.cpp", 1)):
            files = {name: '#include "io/b.hpp"\n' + of("twice();"), "tests/io/b.hpp": twice, "tests/support/a.hpp": "",
                     where: helper}
            self.assertEqual(len(self.found(rules.proving, files)), count, where)

    def test_a_change_of_the_public_face_is_found(self):
        files = {"include/palpate/io/a.hpp": "struct A {\n};\nenum class B { c };\n",
                 "tests/project/public_face.txt": "palpate/io/a.hpp: A B\n"}
        self.assertEqual(self.found(rules.public_face, files), [])
        files["include/palpate/io/a.hpp"] += "class C {\n};\n"
        self.assertEqual(len(self.found(rules.public_face, files)), 2)

    def test_a_long_readme_is_found(self):
        self.assertEqual(len(self.found(rules.readme, {"README.md": "word\n" * 121})), 1)
        self.assertEqual(self.found(rules.readme, {"README.md": "word\n" * 120}), [])

    def test_a_dead_link_is_found(self):
        for name in ("a.md", "docs/a.md", "docs/devices/a.md", "bench/a.md", "bench/notes/a.md"):
            self.assertEqual(len(self.found(rules.links, {name: "[b](b.md)\n"})), 1)
        self.assertEqual(self.found(rules.links, {"docs/a.md": "# It is: `there`\n[a](a.md#it-is-there), [a](#it-is-there)\n"}), [])
        self.assertEqual(len(self.found(rules.links, {"docs/a.md": "# There\n[a](a.md#gone)\n[b](#gone)\n"})), 2)

    def test_an_image_that_is_absent_is_found(self):
        for show in ("![A (b)](images/a.svg)\n", '<img src="images/a.svg" alt="A">\n'):
            self.assertEqual(len(self.found(rules.images, {"docs/a.md": show})), 1, show)
            self.assertEqual(self.found(rules.images, {"docs/a.md": show, "docs/images/a.svg": ""}), [], show)
        self.assertEqual(len(self.found(rules.images, {"docs/a.txt": ""})), 1, "no documents")

    def test_a_document_that_is_absent_is_found(self):
        files = {"docs/there.md": "", "docs/method.md": "## 2. Fields\n\n### 2.1 Kernels\n"}
        for line, count in (("// as gone.md says\n", 1), ('say("docs/gone.md");\n', 1),
                            ("// docs/there.md, there.md, docs/method.md 2.1 and 2\n", 0),
                            ('open(DOCS "/there.md");\n', 0), ('echo >"$scratch/gone.md"\n', 0),
                            ("// (docs/method.md 2.1; docs/method.md 2.2)\n", 1)):
            found = self.found(rules.documents, {**files, "scripts/a.sh": line})
            self.assertEqual(len(found), count, line)
            self.assertEqual(len(self.found(rules.documents, {**files, "src/io/a.hpp": line})),
                             count, line)

    def test_a_refinement_without_source_or_test_is_found(self):
        head = ("Sources in `src/field`, tests in `tests/field` unless said.\n\n"
                "| rule | mends | section; source | test | price |\n|---|---|---|---|---|\n")
        files = {"src/field/a.cpp": "", "tests/field/a_test.cpp": "TEST(Edges, AreSharp) {\n}\nTEST_P(Of, Them) {\n}\n",
                 "src/scene/c.cpp": "", "tests/scene/c_test.cpp": "TEST(Scene, Holds) {\n}\n"}
        for row, count in (("| a | b | 2.8; `a.cpp` | `Edges.AreSharp`, `Of.*` | +3 |", 0), ("| a | b | 2.8; `b.cpp` | `Edges.*` | +3 |", 1),
                           ("| a | b | 2.8; `a.cpp` | `Edges.AreRound` | +3 |", 1), ("| a | b | 2.8; `a.cpp`, scene `c.cpp` | `Of.*`, scene `Scene.*` | +3 |", 0),
                           ("| a | b | 2.8; `c.cpp` | `Scene.*` | +3 |", 2), ("| a | b | 2.8; scene `a.cpp` | scene `Scene.*`, `Of.*` | +3 |", 2),
                           ("| a | b | 2.8; `a.cpp` | `Edges.*` | |", 1)):
            self.assertEqual(len(self.found(rules.refinements, {**files, "docs/refinements.md": head + row + "\n"})), count, row)

    def test_a_long_entry_and_another_version_are_found(self):
        head, build = "## [Unreleased]\n\n", {"CMakeLists.txt": "project(palpate VERSION 0.2.0 LANGUAGES CXX)\n"}
        for text, count in ((head + "- a\n\n## [0.2.0] - 2026-11-21\n\n## [0.1.0] - 2026-11-20\n", 0),
                            (head + "- a\n  goes on\n\n## [0.2.0] - 2026-11-21\n", 1),
                            (head + "- " + "a" * 160 + "\n\n## [0.2.0] - 2026-11-21\n", 1),
                            (head + "## [0.1.0] - 2026-11-20\n", 1)):
            self.assertEqual(len(self.found(rules.changelog, {"CHANGELOG.md": text, **build})), count, text)


if __name__ == "__main__":
    unittest.main()
