// What this browser keeps from visit to visit; nothing where it keeps nothing.

const kPrefix = "palpate.";

export function recall<T>(key: string, otherwise: T): T {
  try {
    const text = localStorage.getItem(kPrefix + key);
    return text === null ? otherwise : (JSON.parse(text) as T);
  } catch {
    return otherwise;
  }
}

export function remember(key: string, value: unknown): void {
  try {
    localStorage.setItem(kPrefix + key, JSON.stringify(value));
  } catch {
    // private browsing: the choice holds for this visit
  }
}
