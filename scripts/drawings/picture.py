"""Small SVG drawings: panels with axes, in data's coordinates."""

import math

# Colours that remain apart for the colour-blind (Okabe and Ito) and on white paper.
BLUE, ORANGE, GREEN, RED, PURPLE, GREY, LIGHT = "#0072b2", "#d55e00", "#009e73", "#c0392b", "#9a4f96", "#666", "#ddd"
INK = "#222"
GAP = 4  # pixels between a label and what it labels


def number(x):
    text = f"{x:.1f}"
    return text[:-2] if text.endswith(".0") else text


def escape(text):
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


class Picture:
    """What is drawn, in pixels from the upper left corner."""

    def __init__(self, width, height, title):
        self.width, self.height = width, height
        self.parts = [f"<title>{escape(title)}</title>", f'<rect width="{width}" height="{height}" fill="#fff"/>']

    def add(self, part):
        self.parts.append(part)

    def text(self, x, y, words, color=INK, anchor="start", size=13, turned=False, bold=False):
        turn = f' transform="rotate(-90 {number(x)} {number(y)})"' if turned else ""
        weight = ' font-weight="bold"' if bold else ""
        self.add(f'<text x="{number(x)}" y="{number(y)}" fill="{color}" text-anchor="{anchor}" font-size="{size}"{weight}{turn}>{escape(words)}</text>')

    def svg(self):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" width="{self.width}" '
                f'height="{self.height}" font-family="DejaVu Sans, Verdana, sans-serif">')
        return "\n".join([head, *self.parts, "</svg>", ""])


class Panel:
    """A part of a picture with axes of its own. `box`: left, top, width and height in pixels; `x`, `y`: what it spans."""

    def __init__(self, picture, box, x, y, title="", equal=False):
        self.picture, self.title = picture, title
        self.left, self.top, self.width, self.height = box
        self.x, self.y = x, y
        if equal:  # as many units a pixel along both axes: y is widened or narrowed around its middle
            half = (x[1] - x[0]) * self.height / self.width / 2
            middle = (y[0] + y[1]) / 2
            self.y = (middle - half, middle + half)
        picture.add(f'<clipPath id="c{self.left}-{self.top}"><rect x="{self.left}" y="{self.top}" width="{self.width}" height="{self.height}"/></clipPath>')
        picture.text(self.left, self.top - 8, title, bold=True)

    def at(self, x, y):
        across = (x - self.x[0]) / (self.x[1] - self.x[0])
        up = (y - self.y[0]) / (self.y[1] - self.y[0])
        return self.left + across * self.width, self.top + (1 - up) * self.height

    def scale(self, length):
        return length / (self.x[1] - self.x[0]) * self.width

    def axes(self, across, up, x_ticks, y_ticks):
        """Frame, ticks and what they count."""
        p = self.picture
        p.add(f'<rect x="{self.left}" y="{self.top}" width="{self.width}" height="{self.height}" fill="none" stroke="#999"/>')
        for tick in x_ticks:
            x, y = self.at(tick, self.y[0])
            p.add(f'<path d="M{number(x)} {number(y)}v5" stroke="#999"/>')
            p.text(x, y + 18, f"{tick:g}", anchor="middle", size=12)
        for tick in y_ticks:
            x, y = self.at(self.x[0], tick)
            p.add(f'<path d="M{number(x)} {number(y)}h-5" stroke="#999"/>')
            p.text(x - 8, y + GAP, f"{tick:g}", anchor="end", size=12)
        p.text(self.left + self.width / 2, self.top + self.height + 36, across, anchor="middle")
        p.text(self.left - 50, self.top + self.height / 2, up, anchor="middle", turned=True)

    def put(self, part):
        self.picture.add(f'<g clip-path="url(#c{self.left}-{self.top})">{part}</g>')

    def path(self, points, closed=False):
        pixels = [tuple(map(number, self.at(x, y))) for x, y in points]
        return "M" + "L".join(f"{x} {y}" for x, y in pixels) + ("Z" if closed else "")

    def line(self, points, color=INK, width=2.0, dash="", opacity=1):
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        thin = f' opacity="{opacity}"' if opacity < 1 else ""
        self.put(f'<path d="{self.path(points)}" fill="none" stroke="{color}" stroke-width="{width:g}"{dashed}{thin}/>')

    def lines(self, many, color=INK, width=2.0, dash=""):
        """Several lines as one path."""
        if many:
            dashed = f' stroke-dasharray="{dash}"' if dash else ""
            self.put(f'<path d="{"".join(map(self.path, many))}" fill="none" stroke="{color}" stroke-width="{width:g}"{dashed}/>')

    def area(self, loops, color, opacity=1.0):
        self.put(f'<path d="{"".join(self.path(loop, True) for loop in loops)}" fill="{color}" fill-opacity="{opacity:g}" fill-rule="evenodd"/>')

    def dots(self, points, color=INK, size=3.0):
        where = ((number(x), number(y)) for x, y in (self.at(*p) for p in points))
        self.put("".join(f'<circle cx="{x}" cy="{y}" r="{size:g}" fill="{color}"/>' for x, y in where))

    def ring(self, center, radius, color=GREY, width=1.0, dash="", fill="none", opacity=1.0):
        x, y = self.at(*center)
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        self.put(f'<circle cx="{number(x)}" cy="{number(y)}" r="{number(self.scale(radius))}" fill="{fill}" fill-opacity="{opacity:g}" stroke="{color}" stroke-width="{width:g}"{dashed}/>')

    def arrow(self, start, end, color=INK, width=1.5, head=7.0):
        (x0, y0), (x1, y1) = self.at(*start), self.at(*end)
        angle = math.atan2(y1 - y0, x1 - x0)
        wings = "".join(f"M{number(x1)} {number(y1)}L{number(x1 - head * math.cos(angle + side))} {number(y1 - head * math.sin(angle + side))}"
                        for side in (0.45, -0.45))
        self.put(f'<path d="M{number(x0)} {number(y0)}L{number(x1)} {number(y1)}{wings}" fill="none" stroke="{color}" stroke-width="{width:g}"/>')

    def text(self, x, y, words, color=INK, anchor="start", right=0.0, up=0.0, size=13):
        px, py = self.at(x, y)
        self.picture.text(px + right, py - up, words, color, anchor, size)

    def legend(self, rows, right=10, down=18):
        """Rows of (words, colour, dash), from the upper left corner on."""
        for k, (words, color, dash) in enumerate(rows):
            y = self.top + down + 18 * k
            x = self.left + right
            dashed = f' stroke-dasharray="{dash}"' if dash else ""
            self.picture.add(f'<path d="M{x} {y - 4}h24" stroke="{color}" stroke-width="2.5"{dashed}/>')
            self.picture.text(x + 30, y, words, color)


def level_lines(f, x, y, columns, rows, grid=None):
    """The lines where f(x, y) = 0, by marching squares over columns x rows cells. `grid`: values at the corners."""
    xs = [x[0] + (x[1] - x[0]) * i / columns for i in range(columns + 1)]
    ys = [y[0] + (y[1] - y[0]) * j / rows for j in range(rows + 1)]
    v = grid or [[f(a, b) for a in xs] for b in ys]
    crossing, links = {}, {}

    def cross(i, j, along_x):
        key = (i, j, along_x)
        a, b = v[j][i], v[j][i + 1] if along_x else v[j + 1][i]
        if (a > 0) == (b > 0):
            return None
        t = a / (a - b)
        crossing[key] = (xs[i] + t * (xs[i + 1] - xs[i]), ys[j]) if along_x else (xs[i], ys[j] + t * (ys[j + 1] - ys[j]))
        return key

    for j in range(rows):
        for i in range(columns):
            found = [k for k in (cross(i, j, True), cross(i + 1, j, False), cross(i, j + 1, True), cross(i, j, False)) if k]
            for a, b in zip(found[::2], found[1::2]):
                links.setdefault(a, []).append(b)
                links.setdefault(b, []).append(a)
    return [[crossing[k] for k in chain] for chain in chains(links)]


def chains(links):
    """Paths through a graph whose nodes have two neighbours at most; ends first, then loops."""
    left = {k: list(n) for k, n in links.items()}
    for start in sorted(left, key=lambda k: (len(links[k]), k)):
        chain = [start]
        while left[chain[-1]]:
            following = left[chain[-1]].pop()
            left[following].remove(chain[-1])
            chain.append(following)
        if len(chain) > 1:
            yield chain
