"""Arrays that fit are read where they are, others are copied; what is of another kind or shape is refused in words."""

import copy
import gc
import pickle
import unittest

from support import ball, main, np, pp, stroke


class Refused(unittest.TestCase):
    """Each message names a cast that makes the array one that is taken."""

    def setUp(self):
        self.field = pp.Sphere(0.05)

    def refused(self, array, cast):
        with self.assertRaises(TypeError) as caught:
            self.field.value(array)
        self.assertIn(cast, str(caught.exception))

    def test_objects_and_words(self):
        self.refused(np.full((4, 3), None), "x.astype(np.float64)")
        self.refused(np.full((4, 3), "0.1"), "x.astype(np.float64)")
        self.refused(np.zeros((4, 3), complex), "x.astype(np.float64)")

    def test_other_shapes(self):
        for array in (np.zeros(3), np.zeros(12), np.zeros((2, 2, 3))):
            self.refused(array, "x.reshape(-1, 3)")

    def test_the_advice_on_a_shape_gives_the_points(self):
        points = np.random.default_rng(7).normal(size=(40, 3))
        more = np.hstack([points, np.ones((40, 1))])
        for array in (points.T, points.reshape(5, 8, 3), points.T.reshape(3, 5, 8), points.T.reshape(1, 3, 40),
                      points.reshape(5, 8, 3).transpose(0, 2, 1), more, more.reshape(5, 8, 4), points.reshape(-1)):
            with self.assertRaises(TypeError) as caught:
                self.field.value(array)
            mended = eval(str(caught.exception).split("such as ")[1], {"np": np, "x": array})
            np.testing.assert_array_equal(mended, points)
            self.field.value(mended)

    def test_a_shape_that_holds_no_points_gets_no_advice(self):
        for array in (np.zeros((4, 2)), np.array(1.0), np.zeros((48, 64)), np.zeros((2, 48, 64))):
            with self.assertRaisesRegex(TypeError, r"give shape \(n, 3\)$"):
                self.field.value(array)

    def test_points_as_columns(self):
        array = np.zeros((3, 4))
        self.refused(array, "x.T")
        self.field.value(array.T)

    def test_points_with_more_columns(self):
        array = np.zeros((8, 4))
        self.refused(array, "x[:, :3]")
        self.field.value(array[:, :3])

    def test_structured_arrays_of_other_fields(self):
        """The advice is NumPy's own, and does what it says."""
        from numpy.lib import recfunctions
        array = np.zeros(4, [("lon", "f4"), ("lat", "f4"), ("height", "f8")])
        with self.assertRaises(TypeError) as caught:
            self.field.value(array)
        self.assertIn("('lon', 'lat', 'height')", str(caught.exception))
        self.assertIn("numpy.lib.recfunctions.structured_to_unstructured(x)", str(caught.exception))
        self.field.value(recfunctions.structured_to_unstructured(array[["lon", "lat", "height"]]))
        colors = np.zeros(4, [("r", "u1"), ("g", "u1"), ("b", "u1")])
        with self.assertRaisesRegex(TypeError, "structured_to_unstructured"):
            pp.PointCloud(np.zeros((4, 3)), colors=colors)
        pp.PointCloud(np.zeros((4, 3)), colors=recfunctions.structured_to_unstructured(colors[["r", "g", "b"]]))

    def test_no_array(self):
        for thing in ([[0, 0, 0]], None, 3, "points", ball()):
            self.refused(thing, "np.asarray(x, dtype=np.float64)")

    def test_columns_of_clouds(self):
        points = np.zeros((5, 3))
        with self.assertRaisesRegex(TypeError, r"colors.astype\(np.uint8\)"):
            pp.PointCloud(points, colors=points)
        with self.assertRaisesRegex(TypeError, r"intensities has shape"):
            pp.PointCloud(points, intensities=np.zeros((5, 1), np.float32))
        with self.assertRaisesRegex(pp.Error, "normals"):  # of another length: preparation says so
            pp.prepare(pp.PointCloud(points, normals=points[:2].copy()))

    def test_images(self):
        camera = pp.Scene().add_camera("desk", K=(500, 500, 32, 24), size=(64, 48))
        for image, words in ((np.zeros((64, 48), np.uint16), "depth.T"), (np.zeros((48, 64), np.int32), r"depth.astype\(np.uint16\)"),
                             (np.zeros((48, 64), np.uint32), r"depth.astype\(np.uint16\)")):
            with self.assertRaisesRegex(TypeError, words):
                camera.push(image, 0.0)

    def test_poses(self):
        for pose, words in ((np.diag([1, 1, -1, 1.0]), "mirrors"), (np.diag([2, 2, 2, 1.0]), "scales"),
                            (np.zeros((4, 4)), "last row"), (np.diag([0, 0, 0, 1.0]), "scales"),
                            (np.eye(3), r"shape \(3, 3\); give a \(4, 4\)"), (np.diag([1, 1, -1, 1.0])[:3], "mirrors")):
            with self.assertRaisesRegex(pp.Error, words):
                pp.Scene().add_camera("desk", K=(500, 500, 32, 24), size=(64, 48), pose=pose)
            with self.assertRaisesRegex(pp.Error, words):
                pp.Scene().add("cloud", np.random.default_rng(0).normal(size=(50, 3)), pose=pose)

    def test_lens_as_a_matrix(self):
        for K, words in ((np.eye(3), r"K\[0, 0\], K\[1, 1\]"), ((500, 500), r"\(500, 500\); give \(fx, fy, cx, cy\)")):
            with self.assertRaisesRegex(TypeError, words):
                pp.Scene().add_camera("desk", K=K, size=(64, 48))

    def test_masks(self):
        points = np.ma.masked_array(np.zeros((5, 3)))
        points[2] = np.ma.masked
        with self.assertRaisesRegex(TypeError, r"np.ma.compress_rows\(points\)"):
            pp.Scene().add("cloud", points)
        camera = pp.Scene().add_camera("desk", K=(500, 500, 32, 24), size=(64, 48))
        with self.assertRaisesRegex(TypeError, r"depth.filled\(0\)"):
            camera.push(np.ma.masked_greater(np.full((48, 64), 700, np.uint16), 500), 0.0)

    def test_words(self):
        with self.assertRaisesRegex(TypeError, "voxel"):
            pp.prepare(np.zeros((5, 3)), voxle=1)
        with self.assertRaisesRegex(TypeError, "stiffness"):
            pp.Proxy(stiffness="hard")
        with self.assertRaisesRegex(pp.Error, "balanced, pointset, metaball"):
            pp.Field(ball(), kind="flat")


class Taken(unittest.TestCase):
    """What is no float64 row by row gives what its copy gives."""

    def same(self, array):
        np.testing.assert_array_equal(pp.Sphere(0.05).value(array), pp.Sphere(0.05).value(np.array(array, np.float64, order="C")))

    def test_slices_and_transposes(self):
        rows = np.random.default_rng(1).normal(size=(12, 6))
        for array in (rows[:, :3], rows[::2, ::2], rows[::-1, 3:], rows[:, 2::-1], rows[:3].T, np.broadcast_to(rows[0, :3], (4, 3))):
            self.assertFalse(array.flags.c_contiguous)
            self.same(array)

    def test_other_numbers(self):
        rows = np.arange(12).reshape(4, 3)
        for name in ("float16", "longdouble", "int8", "int64", "uint16", ">f8", ">f4", ">i4"):
            self.same(rows.astype(name))

    def test_structured_arrays(self):
        """As sensor_msgs_py and ros2_numpy (x, y, z among other fields, in any order) and pyrealsense2 (f0, f1, f2) give them."""
        random = np.random.default_rng(9)
        for kind in ([(name, "<f4") for name in ("x", "y", "z", "intensity", "rgb")], [(name, "<f4") for name in ("f0", "f1", "f2")],
                     {"names": ["z", "ring", "x", "y"], "formats": ["f8", "u2", "f8", "f8"], "offsets": [16, 24, 0, 8], "itemsize": 32},
                     [("x", ">f4"), ("y", ">f4"), ("z", ">f4")], [("x", "i4"), ("y", "i4"), ("z", "i4")]):
            for shape in (12, (3, 4), (1, 12)):  # organised clouds are read row by row
                array = np.zeros(shape, kind)
                names = ("f0", "f1", "f2") if "f0" in array.dtype.names else ("x", "y", "z")
                for name in array.dtype.names:
                    array[name] = random.normal(size=shape) * 10
                plain = np.stack([array[name].ravel() for name in names], axis=1)
                np.testing.assert_array_equal(pp.PointCloud(array).points, pp.PointCloud(plain).points)
                np.testing.assert_array_equal(pp.Sphere(0.05).value(array), pp.Sphere(0.05).value(plain))
        with self.assertRaisesRegex(TypeError, "structured_to_unstructured"):
            pp.PointCloud(np.ma.masked_array(np.zeros(3, [("x", "f4"), ("y", "f4"), ("z", "f4")])))

    def test_poses_of_three_rows(self):
        random = np.random.default_rng(10)
        points = random.normal(size=(50, 3)) * 0.02
        for _ in range(10):
            pose = np.eye(4)
            pose[:3, :3], pose[:3, 3] = np.linalg.qr(random.normal(size=(3, 3)))[0], random.normal(size=3)
            pose[:3, 0] *= np.linalg.det(pose[:3, :3])
            scene = pp.Scene()
            np.testing.assert_array_equal(scene.add("whole", points, pose=pose).pose, pose)
            source = scene.add("rows", points, pose=pose[:3])
            np.testing.assert_array_equal(source.pose, pose)
            source.set_pose(pose[:3].tolist())
            np.testing.assert_array_equal(source.pose, pose)

    def test_not_aligned(self):
        memory = b"." + np.arange(12.0).tobytes()
        self.same(np.frombuffer(memory, np.uint8)[1:].view(np.float64).reshape(4, 3))

    def test_columns_of_clouds(self):
        rows = np.arange(15).reshape(5, 3)
        wide = np.arange(30, dtype=np.uint8).reshape(5, 6)
        cloud = pp.PointCloud(rows, normals=rows[:, ::-1], colors=wide[:, :3], intensities=rows[:, 1])
        np.testing.assert_array_equal(cloud.points, rows)
        np.testing.assert_array_equal(cloud.colors, wide[:, :3])
        np.testing.assert_array_equal(cloud.intensities, rows[:, 1])

    def test_images(self):
        depth = np.full((96, 64), 800, np.uint16)
        wanted = self.pushed(depth[:48])
        for image in (depth[::2], np.full((64, 48), 800, np.uint16).T, depth[:48].astype(">u2"), np.full((48, 64), 0.8)):
            np.testing.assert_allclose(self.pushed(image), wanted, atol=1e-6)

    def test_depth_in_other_units_says_so(self):
        """The state says why an image is no surface, and what it says makes it one."""
        for image, words, mended, unit in ((np.full((48, 64), 700, np.float32), "depth * np.float32(0.001)", np.float32(0.001), 1e-3),
                                           (np.full((48, 64), 60000, np.uint16), "another unit= to add_camera() than 0.001 m a step", 1, 1e-5),
                                           (np.full((48, 64), 90, np.uint16), "nearer than 0.1 m", 1, 0.01)):
            scene = pp.Scene()
            camera = scene.add_camera("desk", K=(500, 500, 32, 24), size=(64, 48))
            camera.push(image, 0.0)
            for state in (camera.state(), scene.state(0)):
                self.assertIn(words, state.problem)
                self.assertIn("median", repr(state))
            camera = pp.Scene().add_camera("desk", K=(500, 500, 32, 24), size=(64, 48), unit=unit)
            camera.push(image * mended, 0.0)
            self.assertEqual(camera.state().problem, "")
            self.assertGreater(len(camera.points().points), 100)
        camera.push(np.zeros((48, 64), np.uint16), 1.0)
        self.assertEqual(camera.state().problem, "", "nothing was measured: a covered lens is no unit")

    def pushed(self, image):
        camera = pp.Scene().add_camera("desk", K=(500, 500, 32, 24), size=(64, 48))
        camera.push(image, 0.0)
        points = camera.points().points
        self.assertGreater(len(points), 100)
        return points

    def test_float32_and_read_only(self):
        hand = stroke()
        hand.setflags(write=False)
        field = pp.Sphere(0.06)
        wide = pp.rollout(field, pp.Proxy(), hand)
        narrow = pp.rollout(field, pp.Proxy(), hand.astype(np.float32))
        np.testing.assert_allclose(wide.force, narrow.force, atol=1e-2)

    def test_empty(self):
        none = np.empty((0, 3))
        self.assertEqual(len(pp.rollout(pp.Plane(), pp.Proxy(), none)), 0)
        self.assertEqual(pp.Plane().value(none).shape, (0,))
        self.assertEqual(pp.Plane().gradient(none).shape, (0, 3))
        with self.assertRaises(pp.Error):
            pp.prepare(none)

    def test_not_finite(self):
        for bad in (np.nan, np.inf):
            points = np.zeros((9, 3))
            points[4, 1] = bad
            with self.assertRaisesRegex(pp.Error, "finite"):
                pp.prepare(points)
            out = pp.rollout(pp.Plane(), pp.Proxy(), points)
            self.assertTrue(np.isfinite(out.force).all() and np.isfinite(out.proxy).all())
            self.assertIn("fault", pp.note_names(int(out.notes[-1])))
            self.assertTrue(np.isfinite(pp.Field(ball()).value(points)).all())
        with self.assertRaises(pp.Error):
            pp.rollout(pp.Plane(), pp.Proxy(), np.zeros((2, 3)), dt=np.nan)

    def test_survey_coordinates_keep_their_digits(self):
        points = pp.synthetic_cloud("sphere").points
        cloud = pp.PointCloud(points + [5e5, 4e6, 100])
        np.testing.assert_allclose(cloud.points - [5e5, 4e6, 100], points, atol=1e-7)
        np.testing.assert_array_equal(pp.PointCloud(points.astype(np.float32)).positions, points.astype(np.float32))

    def test_the_hand_is_not_copied(self):
        hand = stroke(2000)
        view = np.ndarray(hand.shape, buffer=hand)  # what is written through it later is what is read
        hand[:] = (0, 0, -1e-3)
        self.assertTrue(pp.rollout(pp.Plane(), pp.Proxy(), view).touching.all())


class Given(unittest.TestCase):
    def test_views_cannot_be_written_and_outlive_all(self):
        scene = ball()
        column = scene.add("more", pp.synthetic_cloud("torus")).points().positions
        before = column.copy()
        del scene
        gc.collect()
        pp.prepare(pp.synthetic_cloud("torus"))  # takes what memory was freed
        np.testing.assert_array_equal(column, before)
        with self.assertRaises(ValueError):
            column[0] = 0

    def test_points_of_a_source_are_not_copied(self):
        points = ball().add("more", pp.synthetic_cloud("sphere")).points()
        addresses = {points.positions.__array_interface__["data"][0] for _ in range(3)}
        self.assertEqual(len(addresses), 1)

    def test_frame_outlives_its_camera(self):
        depth = next(iter(pp.open_camera("simulated:desk"))).depth
        gc.collect()
        self.assertGreater(depth.mean(), 0)
        self.assertFalse(depth.flags.writeable)

    def test_rollouts_can_be_saved(self):
        out = pp.rollout(pp.Sphere(0.06), pp.Proxy(), stroke(100))
        self.assertEqual({len(column) for column in out.columns().values()}, {100})
        self.assertIn("largest force", repr(out))

    def test_pickling_says_what_to_do(self):
        scene = ball()
        out = pp.rollout(pp.Sphere(0.06), pp.Proxy(), stroke(10))
        for thing, remedy in ((out, "columns"), (scene, "in each process"), (pp.Field(scene), "in each process"), (pp.Proxy(), "in each process"),
                              (pp.synthetic_cloud("sphere"), "write_cloud"), (pp.prepare(pp.synthetic_cloud("sphere")), "prepare")):
            for attempt in (pickle.dumps, copy.copy):
                with self.assertRaisesRegex(TypeError, remedy):
                    attempt(thing)

    def test_notebooks_show_a_table(self):
        cloud = pp.synthetic_cloud("sphere")
        out = pp.rollout(pp.Sphere(0.06), pp.Proxy(), stroke(10))
        for thing, words in ((cloud, f"float32 ({len(cloud)}, 3)"), (out, "(n, 3) on the hand, N"), (pp.prepare(cloud).report, "median, m"),
                             (ball().state(0), "stamp"), (pp.Proxy().step(pp.Plane(), (0, 0, 1)), "&lt;palpate.Contact")):
            self.assertIn(words, thing._repr_html_())


main()
