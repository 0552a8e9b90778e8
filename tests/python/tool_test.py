"""Tools that turn do in Python what they do in C++."""

import unittest

from support import main, np, pp


def at(position, turn=0.0):
    """A pose (4, 4): turned about x by `turn`, rad."""
    pose = np.eye(4)
    c, s = np.cos(turn), np.sin(turn)
    pose[1:3, 1:3] = (c, -s), (s, c)
    pose[:3, 3] = position
    return pose


def sheet():
    """A square of 120 mm in z = 0."""
    x, y = np.meshgrid(np.arange(-0.06, 0.06, 0.004), np.arange(-0.06, 0.06, 0.004))
    scene = pp.Scene()
    scene.add("sheet", np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)]))
    return scene


def pressed(proxy, height, steps=400):
    """Lowers the tool from 50 mm, and lets it rest."""
    proxy.reset(at((0, 0, 0.05)))
    for z in np.linspace(0.05, height, steps):
        proxy.step(at((0, 0, z)))
    for _ in range(steps):
        contact = proxy.step(at((0, 0, height)))
    return contact


class Tools(unittest.TestCase):
    def test_a_box_rests_on_a_formula_and_on_a_cloud(self):
        box = pp.Tool("box:40x60x20", spacing=0.004)
        for touched in (pp.Plane(), sheet()):
            contact = pressed(pp.ToolProxy(box, touched, stiffness=500), 0.007)
            self.assertTrue(contact.touching)
            np.testing.assert_allclose(contact.force, (0, 0, 1.5), atol=2e-3)
            np.testing.assert_allclose(contact.torque, 0, atol=2e-4)
            np.testing.assert_allclose(contact.pose, at((0, 0, 0.01)), atol=1e-5)
            self.assertAlmostEqual(contact.forces.sum(), 1.5, delta=2e-3)
            self.assertEqual(contact.normals.shape, contact.positions.shape)

    def test_a_tilted_box_feels_a_torque(self):
        proxy = pp.ToolProxy(pp.Tool("box:40x60x20", spacing=0.004), pp.Plane())
        proxy.reset(at((0, 0, 0.05), 0.1))
        for z in np.linspace(0.05, 0.01, 300):
            contact = proxy.step(at((0, 0, z), 0.1))
        self.assertGreater(abs(contact.torque[0]), 1e-3)
        self.assertLess(np.abs(contact.torque[1:]).max(), 1e-9)

    def test_a_tool_rubs_on_a_plane(self):
        proxy = pp.ToolProxy(pp.Tool("box:40x60x20", spacing=0.004), pp.Plane(), stiffness=500, friction_dynamic=0.5)
        pressed(proxy, 0.007)
        for x in np.linspace(0, 0.02, 400):
            contact = proxy.step(at((x, 0, 0.007)))
        self.assertTrue(contact.sliding)
        self.assertAlmostEqual(contact.force[0], -0.75, delta=0.02)
        np.testing.assert_allclose(contact.frictions.sum(axis=0), contact.force - (0, 0, 1.5), atol=0.02)

    def test_a_tool_feels_a_texture(self):
        box = pp.Tool("box:40x60x20", spacing=0.004)
        proxy = pp.ToolProxy(box, pp.Plane(), stiffness=500, texture_amplitude=1e-4, texture_wavelength=4e-3)
        force = pressed(proxy, 0.007).force[2]  # carved 0 to 2 amplitudes deep
        self.assertLess(force, 1.5 - 1e-3)
        self.assertGreater(force, 1.5 - 500 * 2e-4)
        with self.assertRaisesRegex(pp.Error, "wavelength"):
            pp.ToolProxy(box, pp.Plane(), texture_wavelength=0)

    def test_a_mesh_is_a_tool(self):
        corners = 0.01 * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        faces = np.array([(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6),
                          (0, 6, 4), (1, 5, 7), (1, 7, 3)])
        cube = pp.Tool.mesh(corners, faces, spacing=0.003)
        self.assertGreater(len(cube), 100)
        np.testing.assert_allclose(np.abs(cube.samples).max(axis=1), 0.01, atol=1e-12)
        np.testing.assert_allclose(pressed(pp.ToolProxy(cube, pp.Plane()), 0.008).force, (0, 0, 1), atol=1e-6)
        with self.assertRaisesRegex(pp.Error, "vert"):
            pp.Tool.mesh(corners, np.array([(0, 1, 8)]), spacing=0.003)
        with self.assertRaisesRegex(pp.Error, "vert"):
            pp.Tool.mesh(corners, np.array([(0, 1, -1)]), spacing=0.003)
        with self.assertRaisesRegex(TypeError, "triangles"):
            pp.Tool.mesh(corners, np.array([0, 1, 2]), spacing=0.003)

    def test_a_gripper_holds_a_ball(self):
        proxy = pp.ToolProxy(pp.Tool("gripper:6x12x30", spacing=0.003), pp.Sphere(0.01))
        proxy.reset(at((0, 0, 0.015)), opening=0.04)
        for opening in np.linspace(0.04, 0.016, 400):
            contact = proxy.step(at((0, 0, 0.015)), opening=opening)
        self.assertAlmostEqual(contact.grip, 500 * 0.004, delta=0.05)
        self.assertAlmostEqual(contact.opening, 0.02, delta=2e-4)

    def test_bad_input_is_refused(self):
        with self.assertRaisesRegex(pp.Error, "box"):
            pp.Tool("box:40x60", spacing=0.004)
        tool = pp.Tool("ball:5", spacing=0.004)
        with self.assertRaisesRegex(TypeError, "scene"):
            pp.ToolProxy(tool, pp.Field(sheet()))
        with self.assertRaises(TypeError):
            pp.ToolProxy(tool, None)
        with self.assertRaises(pp.Error):
            pp.ToolProxy(tool, pp.Plane(), stiffness=-1)
        proxy = pp.ToolProxy(tool, pp.Plane())
        with self.assertRaises(pp.Error):
            proxy.step(2 * np.eye(4))
        self.assertIn("fault", pp.note_names(proxy.step(at((0, 0, 1)), dt=float("nan")).notes))


main()
