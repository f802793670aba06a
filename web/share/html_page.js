// A request and its plan as one HTML file that shows them anywhere, without a server. It contains the scene, the
// player, the styles and the scripts of the page. It has no imports, so that it loads alone.

const VIEWER = new URL("viewer.js", import.meta.url);
const IMPORT = /(\bfrom\s*|\bimport\s*)"(\.[^"]+)"/g;
const DROPPED = [
  "#show-closest",
  "#follow",
  "#ruler",
  "#drop-hint",
  "#welcome",
  "#placing",
  "#minimap",
  "#inspector",
  "#travel",
  "#travel-choice",
  ".timeline",
  "#comparison",
];

/** The text of the file that shows `plan`, a plan file, under a name. */
export async function sharedPage(name, plan) {
  const { code, modules } = await gathered(VIEWER);
  const data = JSON.stringify({ name, document: plan });
  return assembled({ name, style: stylesOf(document), body: bodyOf(document), data, code, modules });
}

/** The document of these parts; `modules` maps the names that the code imports to the code of each. */
export function assembled({ name, style, body, data, code, modules }) {
  const imports = Object.fromEntries(
    Object.entries(modules).map(([module, text]) => [
      module,
      `data:text/javascript;charset=utf-8,${encodeURIComponent(text)}`,
    ]),
  );
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>${inText(name)} – Fleetplan</title>
<style>${style.replaceAll("</", "<\\/")}</style>
</head>
<body class="shared">
${body}
<script type="application/json" id="shared">${inScript(data)}</script>
<script type="importmap">${inScript(JSON.stringify({ imports }))}</script>
<script type="module">${code.replaceAll("</script", "<\\/script")}</script>
</body>
</html>
`;
}

/** JSON that cannot end its script. */
const inScript = (json) => json.replaceAll("<", "\\u003c");

const inText = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");

/**
 * A module and all that it imports: {code, modules}, in which the paths of imports are replaced by names. The bundle of
 * the page has it in one file.
 */
async function gathered(entry) {
  const names = new Map(); // address -> name
  const modules = {};
  const read = async (address) => {
    const text = await (await fetch(address)).text();
    const found = [...text.matchAll(IMPORT)].map(([, , path]) => new URL(path, address).href);
    const fresh = found.filter((each) => !names.has(each));
    for (const each of fresh) names.set(each, `part-${names.size}`);
    for (const each of fresh) modules[names.get(each)] = await read(each);
    return text
      .replace(IMPORT, (_, word, path) => `${word}"${names.get(new URL(path, address).href)}"`)
      .replace(/^\/\/# sourceMappingURL=.*$/m, "");
  };
  return { code: await read(entry.href), modules };
}

/** All rules of a document's style sheets, including imported style sheets. */
function stylesOf({ styleSheets }) {
  const textOf = (sheet) =>
    [...sheet.cssRules]
      .map((rule) => (rule instanceof CSSImportRule ? textOf(rule.styleSheet) : rule.cssText))
      .join("\n");
  return [...styleSheets].map(textOf).join("\n");
}

/** The scene and the player, as they are in the page, without what needs a service. */
function bodyOf(page) {
  const stage = page.querySelector(".stage").cloneNode(true);
  for (const part of DROPPED) stage.querySelector(part)?.remove();
  const title = page.createElement("header");
  title.className = "shared-title";
  title.innerHTML = '<h1 id="title"></h1><p id="facts" class="facts"></p>';
  const save = page.createElement("button");
  Object.assign(save, {
    type: "button",
    id: "save-plan",
    className: "quiet",
    textContent: "Save request and plan",
  });
  title.append(save);
  return title.outerHTML + stage.outerHTML;
}
