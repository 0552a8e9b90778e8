// What a tab touches first: its address says so.

/** A synthetic cloud by its name, the file at an address, or one that was given. */
export interface Wanted {
  name: string;
  at?: string;
  file?: File;
  unit?: number; // metres a unit of the file; absent: the likely one
  news?: string; // to be said where it is touched
}

export const kFirst = "synthetic:rabbit";

/** What a person reads meanwhile. */
export const preparing = ({ name }: Wanted) => `preparing ${name.replace(/^synthetic:/, "")}`;

/** `?cloud=synthetic:torus`, or `?at=clouds/x.ply`: a file below the page's own folder, and nowhere else. */
export function wantedAt(address: string): Wanted {
  const query = new URL(address).searchParams;
  const at = query.get("at");
  if (at === null) return { name: query.get("cloud") ?? kFirst };
  const site = new URL(".", address);
  const place = placeOf(at, site);
  if (place === undefined || place.origin !== site.origin || !place.pathname.startsWith(site.pathname)) {
    return { name: kFirst, news: `${at} is not below this page's folder: download it, and drop it here` };
  }
  return { name: fileAt(place), at: place.href };
}

function placeOf(at: string, site: URL): URL | undefined {
  try {
    return new URL(at, site);
  } catch {
    return undefined;
  }
}

function fileAt(place: URL): string {
  const last = place.pathname.split("/").pop() ?? "";
  try {
    return decodeURIComponent(last);
  } catch {
    return last;
  }
}
