"""Draws figures from palpate's measurements: the paper's, and the Z-width.

Usage: figures.py FOLDER PICTURE. FOLDER holds facts.json and table.csv.
"""

import os
import sys

from drawing import FAINT, INK, load_facts, np, plt, use_style

METABALL = "#dd8a00"
POINTSET = "#2b6cb0"
OURS = "#c53030"
PAPER = "#b8c2cc"
COLORS = {"metaball": METABALL, "point-set": POINTSET, "palpate": OURS}
SHOWN_SECONDS = 2.0


def load(folder):
    """The facts and the table, column by column."""
    table = np.genfromtxt(os.path.join(folder, "table.csv"), delimiter=",", names=True)
    return load_facts(folder), table


def head(figure, title, subtitle):
    """Title and subtitle in the upper left corner."""
    figure.text(0.045, 0.945, title, fontsize=16, fontweight="bold", color=INK)
    figure.text(0.045, 0.905, subtitle, fontsize=10.5, color=FAINT)


def fig5(facts, picture):
    """Times of the three steps at the four sizes, the paper's beside ours, on logarithmic axes."""
    rows = facts["rows"][::-1]
    names = ["index", "normals", "spacing"]
    figure, all_axes = plt.subplots(1, 3, figsize=(12.6, 5.2), dpi=150, sharey=True)
    figure.subplots_adjust(left=0.075, right=0.985, top=0.8, bottom=0.125, wspace=0.06)
    places = np.arange(len(rows))
    for i, (axes, name) in enumerate(zip(all_axes, names)):
        for shift, key, color, label in ((-0.2, "paper_ms", PAPER, "the paper"),
                                         (0.2, "here_ms", OURS, "palpate")):
            times = [row[key][i] for row in rows]
            axes.bar(places + shift, times, 0.36, color=color, label=label)
            for place, time in zip(places + shift, times):
                axes.text(place, time * 1.07, f"{time:.3g}", ha="center", va="bottom", fontsize=9,
                          color=INK)
        axes.set_yscale("log")
        axes.set_xticks(places, [f"{row['points']:,}".replace(",", " ") for row in rows])
        axes.set_title("index (the paper: kd-tree)" if name == "index" else name, loc="left",
                       color=INK)
        axes.set_xlabel("points")
        axes.grid(axis="x", visible=False)
    all_axes[0].set_ylabel("ms")
    every = [time for row in rows for key in ("paper_ms", "here_ms") for time in row[key]]
    all_axes[0].set_ylim(0.5 * min(every), 2.5 * max(every))
    all_axes[2].legend(loc="upper left", frameon=False)
    head(figure, "Preparing clouds of four sizes",
         f"paper: Core i7-950, 2012; palpate: {facts['cores']} cores; points from "
         f"{facts['source']}")
    figure.savefig(picture, format="png")


def label_of(press):
    """A press's name as people say it."""
    if press["clouds"] == 0:
        return "palpate's default"
    return f"{press['name']}, N = {press['clouds']}"


def draw_series(axes, table, press, column, scale):
    """One component of the normal, or the height, over some seconds."""
    shown = table["t"] <= table["t"][0] + SHOWN_SECONDS
    values = scale * table[f"{press['key'].replace('-', '')}_{column}"][shown]
    axes.plot(table["t"][shown] - table["t"][0], values, color=COLORS[press["name"]], linewidth=0.9)


def draw_bars(axes, facts, value, scale, title, unit):
    """A standard deviation against N, and ours as a line."""
    for name, shift in (("metaball", -0.19), ("point-set", 0.19)):
        some = [p for p in facts["presses"] if p["name"] == name]
        places = np.array([p["clouds"] for p in some]) + shift
        axes.bar(places, [scale * value(p) for p in some], 0.34, color=COLORS[name], label=name)
    ours = scale * value(facts["presses"][-1])
    axes.axhline(ours, color=OURS, linewidth=1.8, label=f"palpate's default, {ours:.2g} {unit}")
    axes.set_title(title, loc="left", color=INK)
    axes.set_xlabel("N clouds")
    axes.set_ylabel(unit)
    axes.set_xticks([1, 2, 3, 4])
    axes.set_ylim(0, 1.18 * axes.get_ylim()[1])
    axes.grid(axis="x", visible=False)
    axes.legend(loc="upper right", frameon=False)


def fig7(facts, table, picture):
    """The normal's components over time, and what N clouds do to them and to the height."""
    presses = facts["presses"]
    by_key = {p["key"]: p for p in presses}
    columns = [by_key[k] for k in ("metaball_1", "point-set_1", "metaball_4", "point-set_4", "palpate")]
    figure = plt.figure(figsize=(14.4, 9), dpi=150, facecolor="white")
    upper = figure.add_gridspec(2, len(columns), left=0.055, right=0.985, top=0.825, bottom=0.46,
                                wspace=0.08, hspace=0.16)
    first = None
    limit = 1.1 * max(np.abs(np.asarray([table[f"{p['key'].replace('-', '')}_{c}"] for p in columns
                                         for c in ("nx", "ny")])).max(), 1e-3)
    for i, press in enumerate(columns):
        for j, column in enumerate(("nx", "ny")):
            axes = figure.add_subplot(upper[j, i], sharex=first, sharey=first)
            first = first or axes
            draw_series(axes, table, press, column, 1)
            axes.set_ylim(-limit, limit)
            axes.tick_params(labelleft=i == 0, labelbottom=j == 1)
            if i == 0:
                axes.set_ylabel(f"$n_{column[1]}$")
            if j == 0:
                axes.set_title(f"{label_of(press)}\n$R$ = {1e3 * press['radius_m']:.1f} mm", loc="left",
                               color=INK, fontsize=10.5)
            else:
                axes.set_xlabel("time, s")
    lower = figure.add_gridspec(1, 2, left=0.055, right=0.985, top=0.355, bottom=0.065, wspace=0.12)
    draw_bars(figure.add_subplot(lower[0, 0]), facts,
              lambda p: np.hypot(p["nx_sd_degrees"], p["ny_sd_degrees"]), 1,
              "normal: standard deviation of its direction", "degrees")
    draw_bars(figure.add_subplot(lower[0, 1]), facts, lambda p: p["height_sd_m"], 1e3,
              "height: standard deviation", "mm")
    head(figure, "A hand pressed into a static surface",
         f"{facts['depth_m']:.2f} m from the camera, viewing angle "
         f"{facts['angle_degrees']:.0f} degrees; metaball and point-set with {1e3 * facts['voxel_m']:.1f} "
         f"mm voxels, {facts['radius']}, T = 0.5, hard swap; {facts['source']}")
    figure.savefig(picture, format="png")


def zwidth(facts, picture):
    """Stiffness against damping, a panel for each delay; or against rate where damping is one."""
    rows = facts["rows"]
    dampings = sorted({row["damping_Ns_per_m"] for row in rows})
    rates = sorted({row["rate_Hz"] for row in rows})
    delays = sorted({row["delay_steps"] for row in rows})
    by_damping = len(dampings) > 1
    along, unit = ("damping_Ns_per_m", "damping of the device, N s/m") if by_damping else (
        "rate_Hz", "rate, Hz")
    families = rates if by_damping else dampings
    colors = plt.cm.viridis(np.linspace(0.05, 0.8, len(families)))
    figure, panels = plt.subplots(1, len(delays), figsize=(4.6 * len(delays) + 1.2, 5.4), dpi=150,
                                  sharey=True, squeeze=False)
    figure.subplots_adjust(left=0.9 / (4.6 * len(delays) + 1.2), right=0.985, top=0.8, bottom=0.125,
                           wspace=0.06)
    for axes, delay in zip(panels[0], delays):
        for color, family in zip(colors, families):
            key = "rate_Hz" if by_damping else "damping_Ns_per_m"
            some = sorted((r for r in rows if r["delay_steps"] == delay and r[key] == family),
                          key=lambda r: r[along])
            x = [r[along] for r in some]
            name = f"{family:g} Hz" if by_damping else f"{family:g} N s/m"
            axes.plot(x, [r["stable_N_per_m"] for r in some], "o", color=color, label=name)
            axes.plot(x, [r["passive_N_per_m"] for r in some], "x", color=color)
            axes.plot(x, [r["colgate_N_per_m"] for r in some], "--", color=color, linewidth=1)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel(unit)
        axes.set_title(f"{delay} step{'' if delay == 1 else 's'} of delay", loc="left", color=INK)
    panels[0][0].set_ylabel("wall stiffness, N/m")
    panels[0][0].legend(loc="upper left", frameon=False)
    head(figure, f"Largest wall stiffness: {facts['device']}",
         f"dots: stable, crosses: passive, dashed: Colgate's condition; simulated with "
         f"{facts['mass_kg']:g} kg, wall damping {facts['wall_damping_Ns_per_m']:g} N s/m")
    figure.savefig(picture, format="png")


def main(folder, picture):
    facts, table = load(folder)
    use_style()
    if facts["figure"] == "fig5":
        fig5(facts, picture)
    elif facts["figure"] == "fig7":
        fig7(facts, table, picture)
    else:
        zwidth(facts, picture)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
