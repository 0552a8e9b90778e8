import assert from "node:assert/strict";
import { test } from "node:test";
import { kFirst, wantedAt } from "../src/tab/wanted";

const kSite = "https://people.example/palpate/tab/";

test("a tab begins with the rabbit, or with what its address names", () => {
  assert.deepEqual(wantedAt(`${kSite}#stiffness=800`), { name: kFirst });
  assert.deepEqual(wantedAt(`${kSite}index.html?cloud=synthetic:torus`), { name: "synthetic:torus" });
});

test("a file below the page's folder is fetched from there", () => {
  const file = { name: "my scan.ply", at: `${kSite}clouds/my%20scan.ply` };
  assert.deepEqual(wantedAt(`${kSite}?at=clouds/my%20scan.ply#stiffness=800`), file);
  assert.deepEqual(wantedAt(`${kSite}index.html?at=./clouds/../clouds/my%20scan.ply`), file);
  assert.deepEqual(wantedAt(`${kSite}?at=${encodeURIComponent(file.at)}`), file);
  assert.equal(wantedAt(`${kSite}?at=a%25zz.ply`).name, "a%zz.ply");
});

test("nothing is fetched from elsewhere, and it says so", () => {
  for (const at of ["../secret.ply", "/other/x.ply", "//evil.example/palpate/tab/x.ply", "https://evil.example/x.ply", "data:,1", "clouds/%2e%2e/%2e%2e/x.ply", "http://people.example/palpate/tab/x.ply", "https://["]) {
    const wanted = wantedAt(`${kSite}?at=${encodeURIComponent(at)}`);
    assert.deepEqual([wanted.name, wanted.at], [kFirst, undefined], at);
    assert.match(wanted.news ?? "", /not below this page's folder/, at);
  }
});
