"""Fields, proxies, files and streams do in Python what they do in C++."""

import os
import tempfile
import unittest

from support import ball, main, np, pp, stroke


class Fields(unittest.TestCase):
    def test_analytic_forces(self):
        hand = np.array([[0, 0, 0.1], [0, 0, 0.046]])
        out = pp.rollout(pp.Sphere(0.05), pp.Proxy(stiffness=500), hand)
        np.testing.assert_allclose(out.force, [[0, 0, 0], [0, 0, 2]], atol=1e-3)

    def test_poses_move_formulas(self):
        pose = np.eye(4)
        pose[:3, 3] = (1, 2, 3)
        for field, height in ((pp.Plane(pose), 0), (pp.Sphere(0.5, pose), 0.5), (pp.Box((1, 1, 1), pose), 0.5),
                              (pp.Torus(0.5, 0.1, pose), None)):
            if height is not None:
                np.testing.assert_allclose(field.value(np.array([[1.0, 2, 4]])), [1 - height])
        with self.assertRaises(pp.Error):
            pp.Plane(2 * np.eye(4))

    def test_gradient_is_that_of_the_value(self):
        h = 1e-6
        x = stroke(50, 0.061)[25:] * 0.99
        for field in (pp.Field(ball()), pp.Field(ball(), kind="metaball"), pp.Torus(0.05, 0.02)):
            for axis in range(3):
                step = h * np.eye(3)[axis]
                slope = (field.value(x + step, seen_from=x[0] * 1.1) - field.value(x - step, seen_from=x[0] * 1.1)) / (2 * h)
                np.testing.assert_allclose(field.gradient(x, seen_from=x[0] * 1.1)[:, axis], slope, atol=1e-4)

    def test_side_that_is_seen_is_free(self):
        x = np.array([[0, 0, 0.058]])
        field = pp.Field(ball())
        self.assertLess(field.value(x, seen_from=(0, 0, 0.1))[0], 0)
        self.assertGreater(field.value(x, seen_from=(0, 0, 0.05))[0], 0)


class Proxies(unittest.TestCase):
    def test_steps_are_a_rollout(self):
        hand = stroke(500)
        field = pp.Field(ball())
        whole = pp.rollout(field, pp.Proxy(), hand)
        proxy = pp.Proxy()
        field = pp.Field(ball())
        single = [proxy.step(field, hip) for hip in hand]
        np.testing.assert_array_equal(whole.force, [contact.force for contact in single])
        self.assertAlmostEqual(proxy.time, 0.5)

    def test_a_rollout_goes_on(self):
        hand = stroke(500)
        whole = pp.rollout(pp.Field(ball()), pp.Proxy(), hand)
        field, proxy = pp.Field(ball()), pp.Proxy()
        parts = [pp.rollout(field, proxy, part) for part in (hand[:200], hand[200:])]
        np.testing.assert_array_equal(whole.force, np.concatenate([part.force for part in parts]))

    def test_reset_ends_a_fault(self):
        proxy = pp.Proxy()
        pp.rollout(pp.Plane(), proxy, np.full((1, 3), np.nan))
        proxy.reset((0, 0, 1))
        self.assertEqual(proxy.step(pp.Plane(), (0, 0, 0.5)).notes, 0)
        np.testing.assert_array_equal(proxy.position, (0, 0, 0.5))


class Streams(unittest.TestCase):
    def test_camera_of_arrays(self):
        """A wall that comes nearer takes the tool along."""
        scene = pp.Scene()
        camera = scene.add_camera("wall", K=(100, 100, 31.5, 23.5), size=(64, 48), noise=(1e-4, 0, 0), unit=1e-3)
        field, proxy = pp.Field(scene), pp.Proxy()
        hand = np.tile([0, 0, 0.4], (33, 1))
        for i in range(40):
            image = np.full((48, 64), max(500 - 5 * i, 390), np.uint16)
            self.assertTrue(camera.push(image if i % 2 else image.astype(np.float32) * 1e-3, i / 30, pose=np.eye(4)))
            out = pp.rollout(field, proxy, hand, 1 / 990)
        self.assertLess(out.proxy[-1, 2], 0.4)
        self.assertEqual(camera.state().frames, 40)
        with self.assertRaisesRegex(pp.Error, "older than the image before"):
            camera.push(image, 1.0)
        camera.keep()

    def test_clouds(self):
        scene = pp.Scene()
        stream = scene.add_stream("ball", policy="average", history=2)
        field, proxy = pp.Field(scene), pp.Proxy()
        points = pp.synthetic_cloud("sphere", spacing=4e-3).points
        for i in range(4):
            self.assertTrue(stream.push(points, 0.1 * i))
            out = pp.rollout(field, proxy, stroke(100, 0.055))
        self.assertTrue(out.touching[-1])

    def test_recorded_camera_feeds_a_scene(self):
        scene = pp.Scene()
        frames = pp.open_camera("simulated:desk")
        first = next(frames)
        camera = scene.add_camera("desk", K=first.K, size=first.size, distortion=first.distortion)
        self.assertTrue(camera.push(first.depth, first.stamp, pose=first.pose))
        self.assertGreater(len(camera.points()), 10_000)
        self.assertIn("simulated", [driver["name"] for driver in pp.list_cameras()])


class Files(unittest.TestCase):
    def test_what_is_written_is_read(self):
        cloud = pp.synthetic_cloud("sphere")
        with tempfile.TemporaryDirectory() as folder:
            for name in ("a.ply", "a.pcd"):
                path = os.path.join(folder, name)
                pp.write_cloud(path, cloud)
                np.testing.assert_array_equal(pp.read_cloud(path).positions, cloud.positions)
                pp.write_cloud(path, cloud.points, ascii=True)
            with self.assertRaisesRegex(pp.Error, "a.xyz"):
                pp.write_cloud(os.path.join(folder, "a.xyz"), cloud)
            with self.assertRaisesRegex(ValueError, "absent.ply"):
                pp.Scene().add("scan", os.path.join(folder, "absent.ply"))

    def test_a_mesh_is_sampled(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.obj")
            with open(path, "w", encoding="utf-8") as file:
                file.write("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
            self.assertEqual(len(pp.read_cloud(path, scale=1, mesh_spacing=0.1)), 100)
            with self.assertWarnsRegex(UserWarning, "taken as millimetres.* give scale=1 if"):
                self.assertAlmostEqual(np.ptp(pp.read_cloud(path).positions[:, 0]), 1e-3, 5)
            with open(path, "a", encoding="utf-8") as file:
                file.write("# Unit: inch\n")
            self.assertAlmostEqual(np.ptp(pp.read_cloud(path).positions[:, 0]), 0.0254, 3)
            flat = pp.read_cloud(path, scale=(0.5, 2)).positions
            self.assertAlmostEqual(np.ptp(flat[:, 0]), 0.5, 2)

    def test_preparation_reports(self):
        prepared = pp.prepare(pp.synthetic_cloud("sphere"), voxel=0)
        self.assertEqual(prepared.report.points_out, len(prepared.points))
        self.assertGreater(prepared.report.radius, prepared.report.spacing)


main()
