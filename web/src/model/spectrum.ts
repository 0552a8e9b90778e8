import { fft } from "./fft";

export const kWindow = 1024; // samples

/**
 * Amplitude of each frequency (single-sided, Hann window, mean removed) of a signal with several
 * components: the root of the sum of their squares. A sine of amplitude A shows a peak of A.
 */
export class Spectrum {
  readonly amplitudes = new Float64Array(kWindow / 2);
  private readonly hann = Float64Array.from({ length: kWindow }, (_, i) =>
    0.5 * (1 - Math.cos((2 * Math.PI * i) / kWindow)),
  );
  private readonly real = new Float64Array(kWindow);
  private readonly imaginary = new Float64Array(kWindow);

  /** components: arrays of kWindow values each. */
  update(components: readonly ArrayLike<number>[]): Float64Array {
    this.amplitudes.fill(0);
    for (const values of components) this.add(values);
    for (let k = 0; k < this.amplitudes.length; k += 1) {
      this.amplitudes[k] = Math.sqrt(this.amplitudes[k]!);
    }
    return this.amplitudes;
  }

  private add(values: ArrayLike<number>): void {
    let mean = 0;
    for (let i = 0; i < kWindow; i += 1) mean += values[i]! / kWindow;
    for (let i = 0; i < kWindow; i += 1) this.real[i] = (values[i]! - mean) * this.hann[i]!;
    this.imaginary.fill(0);
    fft(this.real, this.imaginary);
    const scale = 4 / kWindow; // 2 for one side, 2 for the window's mean of a half
    for (let k = 1; k < this.amplitudes.length; k += 1) {
      const x = this.real[k]! * scale;
      const y = this.imaginary[k]! * scale;
      this.amplitudes[k]! += x * x + y * y;
    }
  }
}
