// A little help with elements.

type Attributes = Record<string, string | number | boolean | ((event: Event) => void)>;

/** An element with attributes; a function is a listener for the event of its name. */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name, value);
    else if (typeof value === "boolean") element.toggleAttribute(name, value);
    else element.setAttribute(name, String(value));
  }
  element.append(...children);
  return element;
}

export function byId<T extends Element = HTMLElement>(id: string): T {
  const element = document.getElementById(id);
  if (element === null) throw new Error(`the page has no element ${id}`);
  return element as unknown as T;
}

/** Writes only what changed: the browser need not lay out again, screen readers stay calm. */
export function say(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

export function icon(button: Element, name: string): void {
  button.querySelector("use")?.setAttribute("href", `#i-${name}`);
}

/** Calls at most once in an interval, the last time with the newest value. */
export function throttle<T>(interval: number, call: (value: T) => void): (value: T) => void {
  let timer = 0;
  let last = -Infinity;
  return (value) => {
    clearTimeout(timer);
    const wait = last + interval - performance.now();
    const now = () => {
      last = performance.now();
      call(value);
    };
    if (wait <= 0) now();
    else timer = window.setTimeout(now, wait);
  };
}
