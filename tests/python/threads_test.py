"""Other threads of Python go on while palpate computes, and nothing that they do together breaks."""

import gc
import os
import signal
import sys
import threading
import time
import unittest

from support import ball, main, np, pp, stroke


class Counter(threading.Thread):
    """Counts whenever it gets the GIL."""

    def __init__(self):
        super().__init__(daemon=True)
        self.count, self.going, self.begun = 0, True, threading.Event()

    def run(self):
        while self.going:
            self.count += 1
            self.begun.set()
            time.sleep(0)


class Gil(unittest.TestCase):
    """The interpreter takes the GIL from nobody here, so a thread counts only where it is released."""

    def setUp(self):
        self.interval = sys.getswitchinterval()
        sys.setswitchinterval(1000)
        self.counter = Counter()
        self.counter.start()
        self.counter.begun.wait()

    def tearDown(self):
        self.counter.going = False
        self.counter.join()
        sys.setswitchinterval(self.interval)

    def goes_on_during(self, work):
        for _ in range(50):
            before = self.counter.count
            work()
            if self.counter.count > before:
                return
        self.fail("the GIL was kept")

    def test_the_counter_waits_for_what_keeps_it(self):
        before = self.counter.count
        sum(range(10**6))
        self.assertEqual(self.counter.count, before)

    def test_rollout(self):
        hand, field = stroke(100_000), pp.Sphere(0.06)
        self.goes_on_during(lambda: pp.rollout(field, pp.Proxy(), hand))

    def test_values(self):
        x, field = stroke(100_000), pp.Field(ball())
        self.goes_on_during(lambda: field.value(x))

    def test_push(self):
        camera = pp.Scene().add_camera("wall", K=(500, 500, 319.5, 239.5), size=(640, 480))
        images = iter(range(10**6))
        self.goes_on_during(lambda: camera.push(np.full((480, 640), 800, np.uint16), next(images) / 30))

    def test_preparation_and_reading(self):
        cloud = pp.synthetic_cloud("rabbit")
        self.goes_on_during(lambda: pp.prepare(cloud))
        self.goes_on_during(lambda: pp.synthetic_cloud("rabbit"))
        self.goes_on_during(lambda: pp.Scene().add("rabbit", cloud))


class Together(unittest.TestCase):
    def test_one_field_and_proxy_in_many_threads(self):
        field, proxy, hand, failures = pp.Field(ball()), pp.Proxy(), stroke(400), []

        def touch():
            try:
                for _ in range(20):
                    if not np.isfinite(pp.rollout(field, proxy, hand).force).all():
                        failures.append("not finite")
                    field.value(hand[:50])
                    proxy.step(field, hand[0])
            except Exception as error:
                failures.append(error)

        threads = [threading.Thread(target=touch) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])

    def test_push_while_it_is_touched(self):
        scene = pp.Scene()
        stream = scene.add_stream("ball")
        field, points = pp.Field(scene), pp.synthetic_cloud("sphere", spacing=4e-3).points
        stream.push(points, 0.0)
        pusher = threading.Thread(target=lambda: [stream.push(points, 0.1 * i) for i in range(1, 30)])
        pusher.start()
        proxy = pp.Proxy()
        while pusher.is_alive():
            self.assertTrue(np.isfinite(pp.rollout(field, proxy, stroke(100)).force).all())
        pusher.join()

    def test_what_is_used_is_kept(self):
        field = pp.Field(ball())
        source = ball().add("more", pp.synthetic_cloud("sphere"))
        gc.collect()
        self.assertTrue(pp.rollout(field, pp.Proxy(), stroke()).touching[-1])
        self.assertGreater(len(source.points()), 0)

    def test_references_do_not_leak(self):
        hand, field, proxy = stroke(10), pp.Sphere(0.06), pp.Proxy()
        before = sys.getrefcount(hand), sys.getrefcount(field)
        for _ in range(100):
            pp.rollout(field, proxy, hand)
            pp.rollout(field, proxy, hand[::2])
            with self.assertRaises(TypeError):
                pp.rollout(field, proxy, hand[:, :2])
        self.assertEqual((sys.getrefcount(hand), sys.getrefcount(field)), before)


class Interrupted(unittest.TestCase):
    """Ctrl-C ends long work in the middle, and the interpreter goes on."""

    def interrupts(self, work, hearings=2):
        """Sends a signal until `work` ends, and expects that its handler runs so often in the middle: what is heard at the
        end alone is heard once."""
        heard, over = [], threading.Event()

        def handler(number, frame):
            heard.append(number)
            if len(heard) == hearings:
                raise KeyboardInterrupt

        def send():
            while not over.wait(0.02):
                os.kill(os.getpid(), signal.SIGINT)

        before = signal.signal(signal.SIGINT, handler)
        sender = threading.Thread(target=send)
        sender.start()
        try:
            with self.assertRaises(KeyboardInterrupt):
                work()
                over.set()
        finally:
            over.set()
            sender.join()
            signal.signal(signal.SIGINT, before)

    def test_preparing_and_adding(self):
        cloud = pp.synthetic_cloud("sphere", spacing=1.5e-4)  # a second's work and more
        self.interrupts(lambda: pp.prepare(cloud))
        scene = pp.Scene()
        self.interrupts(lambda: scene.add("ball", cloud), hearings=1)
        small = pp.synthetic_cloud("sphere", spacing=4e-3)
        self.assertGreater(len(pp.prepare(small).points), 0)
        scene.add("ball", small)  # what was heard at the end would have left that name taken

    def test_evaluating(self):
        places = np.tile(stroke(1000), (3000, 1))
        field = pp.Field(ball())
        self.interrupts(lambda: field.value(places))
        self.assertEqual(len(field.value(places[:5])), 5)


main()
