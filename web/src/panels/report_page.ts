/** A report's page as nodes without scripts, handlers and addresses, and its styles. */

export interface Report {
  readonly title: string;
  readonly content: DocumentFragment;
  readonly styles: CSSStyleSheet;
}

const LARGEST = 50_000_000;
const REMOVED = "script, style, link, meta, base, iframe, object, embed, form, noscript, title, foreignObject, use";

export function readReport(text: string): Report {
  if (text.length > LARGEST) throw new Error(`the report has ${text.length} characters, at most ${LARGEST} are read`);
  const page = new DOMParser().parseFromString(text, "text/html");
  const title = page.title || "Report";
  const rules = [...page.querySelectorAll("style")].map((style) => style.textContent).join("\n");
  const styles = new CSSStyleSheet();
  // The page's body and root are the shadow root here; no file is loaded by a rule.
  styles.replaceSync(rules.replace(/url\([^)]*\)/g, "none").replace(/@import[^;]*;/g, "").replace(/:root|(?<![\w.#-])(?:html|body)(?![\w-])/g, ":host"));
  for (const element of page.querySelectorAll(REMOVED)) element.remove();
  for (const element of page.querySelectorAll("*")) {
    for (const { name, value } of [...element.attributes]) {
      const isAddress = name === "src" || name.endsWith("href") || name === "action";
      if (name.startsWith("on") || name === "style" || (isAddress && !/^(#|data:image\/)/.test(value))) element.removeAttribute(name);
    }
  }
  const content = document.createDocumentFragment();
  content.append(...[...page.body.childNodes].map((node) => document.importNode(node, true)));
  if (!content.textContent.trim()) throw new Error("the file is not a report: it contains no text");
  return { title, content, styles };
}
