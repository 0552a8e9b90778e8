// Pictures of what tests saw stay in PALPATE_PICTURES, where that is set.

import { mkdir } from "node:fs/promises";
import { join } from "node:path";

export async function picture(page, name) {
  const folder = process.env.PALPATE_PICTURES;
  if (folder === undefined) return;
  await mkdir(folder, { recursive: true });
  await page.screenshot({ path: join(folder, `${name}.png`), timeout: 120_000 });
}
