// Numbers as people read them.

export function decimals(step: number | undefined): number {
  if (step === undefined || !(step > 0)) return 3;
  return Math.min(20, Math.max(0, Math.ceil(-Math.log10(step) - 1e-9)));
}

/** A value as its step has it, but never with fewer than three digits that matter. */
export function inStep(value: number, step: number | undefined): string {
  const digits = value === 0 ? 0 : 2 - Math.floor(Math.log10(Math.abs(value)));
  const places = Math.min(20, Math.max(decimals(step), digits));
  return Number(value.toFixed(places)).toString();
}

/** Three digits that matter; what is next to nothing is nothing. */
export function threeDigits(value: number): string {
  if (Math.abs(value) < 5e-4) return "0";
  return Number(value.toPrecision(3)).toString().replace("-", "−");
}

/** Thousands apart by a narrow space. */
export function whole(value: number): string {
  return Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

export function short(value: number): string {
  if (value < 10_000) return whole(value);
  return value < 1e6 ? `${Math.round(value / 1000)}k` : `${(value / 1e6).toFixed(1)}M`;
}

export function seconds(value: number): string {
  if (!Number.isFinite(value)) return "–";
  if (value < 0.9995) return `${whole(value * 1000)} ms`;
  return value < 9.95 ? `${value.toFixed(1)} s` : `${whole(value)} s`;
}

/** "1:02.35", from 0 on. */
export function clock(value: number): string {
  const hundredths = Math.round(100 * value);
  const rest = (hundredths % 6000) / 100;
  return `${Math.floor(hundredths / 6000)}:${rest.toFixed(2).padStart(5, "0")}`;
}

export function millimetres(value: number): string {
  const mm = value * 1000;
  if (mm >= 999.5) return `${value.toFixed(value < 9.995 ? 2 : 1)} m`;
  return `${mm.toFixed(mm < 10 ? 2 : 1)} mm`;
}

/** How many of a cloud's points are drawn, where it is not nearly all. */
export function fewer(shown: number, all: number): string {
  return shown > 0 && shown < 0.95 * all ? `${short(shown)} of ${short(all)} points are drawn` : "";
}

/** How much of a cloud is no surface that its points agree on, where it is a hundredth or more. */
export function distrust(share: number): string {
  if (share < 0.01) return "";
  return `${(100 * share).toFixed(0)} % of this cloud has low trust and is rendered as a metaball`;
}

/** Bounds of a slider: even for small ranges, by ratio for wide ones that stay above zero. */
export class Scale {
  private readonly byRatio: boolean;

  constructor(
    private readonly least: number,
    private readonly most: number,
  ) {
    this.byRatio = least > 0 && most / least >= 50;
  }

  /** 0 to 1. */
  position(value: number): number {
    const part = this.byRatio
      ? Math.log(value / this.least) / Math.log(this.most / this.least)
      : (value - this.least) / (this.most - this.least);
    return Math.min(1, Math.max(0, part));
  }

  value(position: number): number {
    if (this.byRatio) return this.least * (this.most / this.least) ** position;
    return this.least + position * (this.most - this.least);
  }
}
