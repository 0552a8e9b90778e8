// What a surface sounds like, from what the program reports of it: stiffness, friction and texture.

import type { Setting, SettingValue } from "../protocol/messages";

export interface Surface {
  stiff: number; // share of the stiffest that can be set, 0 to 1
  friction: number; // coefficient
  amplitude: number; // of its texture, m; 0: smooth
  wavelength: number; // of its texture, m; 0: unknown
}

/** What a slip sounds like: noise, the grain that passes, and what sticks and slips. Gains 0 to 1. */
export interface Slip {
  noise: { gain: number; frequency: number; quality: number };
  grain: { gain: number; frequency: number };
  squeak: { gain: number; frequency: number };
}

const kUnknown: Surface = { stiff: 0.25, friction: 0.2, amplitude: 0, wavelength: 0 }; // of a recording: as runs begin, a little rough
const kHighest = 800; // Hz of the stiffest surface's knock; a quarter of that stiffness has half: small loudspeakers play both
const kFullSpeed = 0.15; // m/s that sounds loudest: a quick stroke
const kFullForce = 3; // N that sounds loudest: a firm press
const kFullFriction = 1; // coefficient that sounds loudest: dry rubber
const kWhisper = 0.2; // share of that loudness without friction: a slip on ice is heard, too
const kNoise = 0.9; // gain of the loudest noise
const kDeep = 500; // Hz in the middle of a slow slip's noise
const kBright = 2500; // Hz of a quick one's
const kRough = 0.06; // slope of a texture that hisses as loudly as one can: hairs; a smooth one has 0
const kSteep = 0.18; // slope of a texture over which a tool rattles loudest: the grain of wood
const kHiss = 3; // a rough surface that yields (hair) is brighter by so many times
const kGrain = 1.6; // gain of the loudest grain; the resonance after it takes most of it away
const kLeastTone = 8; // Hz; below that grains are single clicks
const kMostTone = 2000; // Hz; above that nobody hears grains apart from noise
const kSticks = 0.7; // coefficient from which on a slip sticks and slips: rubber, not wood
const kSqueak = 0.3; // gain of the loudest squeak
const kOvertone = 4; // a squeak is so many times as high as the knock
const kCreeps = 0.02; // m/s below which nothing squeaks loudly

const share = (value: number, full: number) => Math.min(1, Math.max(0, value / full));

/** A mass on a spring: its frequency grows with the root of the stiffness. Hz */
export function pitchOf({ stiff }: Surface): number {
  return kHighest * Math.sqrt(Math.max(stiff, 1e-3)); // no lower than can be heard
}

/** speed: of the slip, m/s; force: N. */
export function slipOf(surface: Surface, speed: number, force: number): Slip {
  const { stiff, friction, amplitude, wavelength } = surface;
  const quick = share(speed, kFullSpeed);
  const effort = Math.sqrt(quick * share(force, kFullForce)); // the root of a power is an amplitude
  const rub = kWhisper + (1 - kWhisper) * share(friction, kFullFriction);
  const slope = wavelength > 0 ? (2 * Math.PI * amplitude) / wavelength : 0;
  const hair = share(slope, kRough) * (1 - stiff) ** 2; // stiff grains rattle instead
  const soft = Math.max(stiff, 0.01) ** 0.25; // what is soft swallows some of a sound, and never all
  const tone = wavelength > 0 ? speed / wavelength : 0; // Hz at which grains pass
  return {
    noise: {
      gain: kNoise * effort * rub * soft,
      frequency: (kDeep + (kBright - kDeep) * quick) * (0.8 + 0.4 * stiff) * (1 + kHiss * hair),
      quality: 0.5 + 1.5 * stiff, // what is stiff rings
    },
    grain: {
      gain: tone < kLeastTone ? 0 : kGrain * effort * share(slope, kSteep) * soft,
      frequency: Math.min(kMostTone, Math.max(kLeastTone, tone)),
    },
    squeak: {
      gain: kSqueak * effort * share(friction - kSticks, kFullFriction - kSticks) * share(speed, kCreeps),
      frequency: kOvertone * pitchOf(surface) * (0.85 + 0.3 * quick),
    },
  };
}

function metres(setting: Setting | undefined, value: SettingValue | undefined): number {
  if (typeof value !== "number") return 0;
  return setting?.unit === "mm" ? value / 1000 : value;
}

/** The surface that the settings of a run describe. */
export function surfaceOf(settings: readonly Setting[], values: ReadonlyMap<string, SettingValue>): Surface {
  const of = (key: string) => settings.find((one) => one.key === key);
  const stiffness = values.get("stiffness");
  if (typeof stiffness !== "number") return kUnknown;
  return {
    stiff: share(stiffness, of("stiffness")?.most ?? stiffness),
    friction: Number(values.get("friction") ?? kUnknown.friction),
    amplitude: metres(of("texture"), values.get("texture")),
    wavelength: metres(of("wavelength"), values.get("wavelength")),
  };
}
