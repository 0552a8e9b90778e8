"""Arrays are read where they are; what would have to be cast is refused, with the cast's name."""

import gc
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

    def test_half_precision(self):
        self.refused(np.zeros((4, 3), np.float16), "x.astype(np.float64)")

    def test_whole_numbers(self):
        self.refused(np.zeros((4, 3), np.int64), "x.astype(np.float64)")

    def test_objects_and_words(self):
        self.refused(np.full((4, 3), None), "x.astype(np.float64)")
        self.refused(np.full((4, 3), "0.1"), "x.astype(np.float64)")

    def test_another_byte_order(self):
        for name in ("float64", "float32"):
            self.refused(np.zeros((4, 3), np.dtype(name).newbyteorder()), f"x.astype(np.{name})")

    def test_not_contiguous(self):
        for array in (np.zeros((8, 3))[::2], np.zeros((4, 6))[:, ::2], np.zeros((3, 4)).T, np.zeros((4, 3))[::-1],
                      np.broadcast_to(np.zeros(3), (4, 3))):
            self.refused(array, "x.copy()")
            self.field.value(array.copy())

    def test_not_aligned(self):
        array = np.frombuffer(bytes(4 * 3 * 8 + 1), np.uint8)[1:].view(np.float64).reshape(4, 3)
        self.refused(array, "x.copy()")

    def test_other_shapes(self):
        for array in (np.zeros(3), np.zeros((4, 2)), np.zeros((2, 2, 3)), np.array(1.0)):
            self.refused(array, "x.reshape(-1, 3)")

    def test_points_as_columns(self):
        array = np.zeros((3, 4))
        self.refused(array, "x.T.copy()")
        self.field.value(array.T.copy())

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
        for image, words in ((np.zeros((64, 48), np.uint16), "depth.T.copy"), (np.zeros((48, 64)), "float64"),
                             (np.zeros((48, 64), ">u2"), "depth.astype"), (np.zeros((96, 64), np.uint16)[::2], "depth.copy")):
            with self.assertRaisesRegex(TypeError, words):
                camera.push(image, 0.0)

    def test_words(self):
        with self.assertRaisesRegex(TypeError, "voxel"):
            pp.prepare(np.zeros((5, 3)), voxle=1)
        with self.assertRaisesRegex(TypeError, "stiffness"):
            pp.Proxy(stiffness="hard")
        with self.assertRaisesRegex(pp.Error, "balanced, pointset, metaball"):
            pp.Field(ball(), kind="flat")


class Taken(unittest.TestCase):
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


main()
