/** The last rows of numbers, oldest first; a row is a time and some values. */
export class Ring {
  private readonly columns: Float64Array[];
  private start = 0;
  private count = 0;

  constructor(
    private readonly capacity: number,
    width: number,
  ) {
    this.columns = Array.from({ length: width }, () => new Float64Array(capacity));
  }

  get length(): number {
    return this.count;
  }

  push(...row: number[]): void {
    const at = (this.start + this.count) % this.capacity;
    this.columns.forEach((column, i) => (column[at] = row[i] ?? NaN));
    if (this.count < this.capacity) this.count += 1;
    else this.start = (this.start + 1) % this.capacity;
  }

  clear(): void {
    this.start = 0;
    this.count = 0;
  }

  /** Value of a column; 0 is the oldest row. NaN beyond. */
  at(column: number, row: number): number {
    if (row < 0 || row >= this.count) return NaN;
    return this.columns[column]?.[(this.start + row) % this.capacity] ?? NaN;
  }

  /** The first row whose column 0 is not below a value; columns 0 must ascend. */
  from(value: number): number {
    let low = 0;
    let high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.at(0, middle) < value) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** A column's values from a row on, as an array of its own. */
  copy(column: number, first = 0): Float64Array {
    const from = Math.min(Math.max(0, first), this.count);
    const out = new Float64Array(this.count - from);
    const values = this.columns[column];
    if (values === undefined) return out;
    const begin = (this.start + from) % this.capacity;
    const head = Math.min(out.length, this.capacity - begin);
    out.set(values.subarray(begin, begin + head));
    out.set(values.subarray(0, out.length - head), head);
    return out;
  }
}
