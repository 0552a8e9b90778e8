/** How long to wait before the next attempt, s: doubles up to a bound, scattered by a random number. */
export class Backoff {
  private attempts = 0;

  constructor(
    private readonly random: () => number,
    private readonly first = 0.5,
    private readonly most = 10,
  ) {}

  next(): number {
    const whole = Math.min(this.most, this.first * 2 ** this.attempts);
    this.attempts += 1;
    return whole * (0.75 + 0.25 * this.random());
  }

  reset(): void {
    this.attempts = 0;
  }
}
