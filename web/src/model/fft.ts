/** In-place radix-2 Fourier transform; the length must be a power of two. */
export function fft(real: Float64Array, imaginary: Float64Array): void {
  const n = real.length;
  if (n === 0 || (n & (n - 1)) !== 0 || imaginary.length !== n) {
    throw new RangeError(`fft of ${n} and ${imaginary.length} values: needs an equal power of two`);
  }
  reorder(real, imaginary);
  for (let half = 1; half < n; half *= 2) {
    for (let k = 0; k < half; k += 1) {
      const angle = (-Math.PI * k) / half;
      const c = Math.cos(angle);
      const s = Math.sin(angle);
      for (let i = k; i < n; i += 2 * half) butterfly(real, imaginary, i, i + half, c, s);
    }
  }
}

function butterfly(
  re: Float64Array, im: Float64Array, i: number, j: number, c: number, s: number,
): void {
  const x = re[j]! * c - im[j]! * s;
  const y = re[j]! * s + im[j]! * c;
  re[j] = re[i]! - x;
  im[j] = im[i]! - y;
  re[i]! += x;
  im[i]! += y;
}

function reorder(real: Float64Array, imaginary: Float64Array): void {
  const n = real.length;
  for (let i = 1, j = 0; i < n; i += 1) {
    let bit = n >> 1;
    for (; (j & bit) !== 0; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) {
      [real[i], real[j]] = [real[j]!, real[i]!];
      [imaginary[i], imaginary[j]] = [imaginary[j]!, imaginary[i]!];
    }
  }
}
