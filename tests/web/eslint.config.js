// ESLint's rules for the page and its tests. Run from the root of the repository, see package.json.

import js from "@eslint/js";
import globals from "globals";

export default [
  { ignores: ["**/node_modules/"] },
  js.configs.recommended,
  {
    rules: {
      eqeqeq: "error",
      "no-restricted-properties": [
        "error",
        ...["toReversed", "toSorted", "toSpliced"].map((property) => ({
          property,
          message: "Debian 12's Node and older browsers do not have it; change a copy instead.",
        })),
      ],
      "no-unused-vars": ["error", { varsIgnorePattern: "^_$", ignoreRestSiblings: true }],
      "no-var": "error",
      "object-shorthand": "error",
      "prefer-const": ["error", { destructuring: "all" }],
      "prefer-template": "error",
    },
  },
  { files: ["web/**/*.js"], languageOptions: { globals: globals.browser } },
  { files: ["tests/web/**/*.js"], languageOptions: { globals: { ...globals.node, ...globals.browser } } },
];
