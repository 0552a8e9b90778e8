import { fileURLToPath } from "node:url";
import js from "@eslint/js";
import tseslint from "typescript-eslint";

const root = fileURLToPath(new URL(".", import.meta.url));

export default tseslint.config(
  { ignores: ["dist", ".test-build", "node_modules", "pictures"] },
  js.configs.recommended,
  {
    files: ["**/*.ts"],
    extends: [...tseslint.configs.recommendedTypeChecked],
    languageOptions: { parserOptions: { projectService: true, tsconfigRootDir: root } },
    rules: {
      "@typescript-eslint/no-non-null-assertion": "off", // indices of loops over typed arrays
      "@typescript-eslint/switch-exhaustiveness-check": "error",
    },
  },
  { files: ["test/**/*.ts"], rules: { "@typescript-eslint/no-floating-promises": "off" } }, // test() waits
  {
    files: ["**/*.mjs"],
    languageOptions: {
      globals: {
        Buffer: "readonly", console: "readonly", DataTransfer: "readonly", File: "readonly", document: "readonly", Event: "readonly", location: "readonly", localStorage: "readonly", performance: "readonly",
        process: "readonly", setInterval: "readonly", clearInterval: "readonly", setTimeout: "readonly",
        window: "readonly", URL: "readonly", WebSocket: "readonly", navigator: "readonly", DataView: "readonly", ErrorEvent: "readonly",
        requestAnimationFrame: "readonly",
      },
    },
  },
  { rules: { "max-lines": ["error", 300], eqeqeq: "error" } },
);
