/** A report's page as nodes without scripts, handlers and addresses, and its styles. */

export interface Report {
  readonly title: string;
  readonly content: DocumentFragment;
  readonly styles: CSSStyleSheet;
  /** The report's dark colours follow the page's theme. */
  readonly setDark: (isDark: boolean) => void;
}

const LARGEST = 50_000_000;
const REMOVED = "script, style, link, meta, base, iframe, object, embed, form, noscript, title, foreignObject, use";

export function readReport(text: string): Report {
  if (text.length > LARGEST) throw new Error(`the report has ${text.length} characters, at most ${LARGEST} are read`);
  const page = new DOMParser().parseFromString(text, "text/html");
  const title = page.title || "Report";
  const rules = [...page.querySelectorAll("style")].map((style) => style.textContent).join("\n");
  const styles = new CSSStyleSheet();
  // The page's body and root are the shadow root here, its window the panel.
  styles.replaceSync(withoutFiles(rules)
    .replace(/@import[^;]*;/g, "")
    .replace(/:root|(?<![\w.#-])(?:html|body)(?![\w-])/g, ":host")
    .replace(/@media(?=\s*\((?:max|min)-width)/g, "@container"));
  const inline = new Map<HTMLElement, string>();
  for (const element of page.querySelectorAll(REMOVED)) element.remove();
  for (const element of page.body.querySelectorAll<HTMLElement>("*")) {
    const style = element.getAttribute("style");
    if (style !== null) inline.set(element, withoutFiles(style));
    for (const { name, value } of [...element.attributes]) {
      const isAddress = name === "src" || name.endsWith("href") || name === "action";
      if (name.startsWith("on") || name === "style" || (isAddress && !/^(#|data:image\/)/.test(value))) element.removeAttribute(name);
    }
  }
  const content = document.createDocumentFragment();
  content.append(...[...page.body.childNodes].map((node) => document.adoptNode(node)));
  // The page's policy refuses the attribute, not its properties.
  for (const [element, style] of inline) element.style.cssText = style;
  if (!content.textContent.trim()) throw new Error("the file is not a report: it contains no text");
  const schemes = [...styles.cssRules].flatMap((rule) => {
    if (!(rule instanceof CSSMediaRule)) return [];
    const scheme = /prefers-color-scheme:\s*(dark|light)/.exec(rule.conditionText)?.[1];
    return scheme === undefined ? [] : [{ rule, scheme }];
  });
  const setDark = (isDark: boolean): void => {
    for (const { rule, scheme } of schemes) rule.media.mediaText = (scheme === "dark") === isDark ? "all" : "not all";
  };
  return { title, content, styles, setDark };
}

/** Styles that load no file and stay in their place. */
function withoutFiles(rules: string): string {
  return rules.replace(/url\([^)]*\)/g, "none").replace(/position\s*:\s*(?:fixed|sticky)/g, "position: static");
}
