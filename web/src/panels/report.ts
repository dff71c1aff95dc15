/** Reports of `navette bench`: opened from a file, shown without running anything in them. */

import "./report.css";
import { h } from "../ui/dom";
import { icon } from "../ui/icons";
import { type PanelContext, type PanelInstance, registerPanel } from "./panel";
import { type Report, readReport } from "./report_page";

class ReportPanel implements PanelInstance {
  readonly #body: HTMLElement;
  readonly #page = h("div", { class: "report-page" });
  readonly #bar = h("div", { class: "bar" });
  readonly #name = h("span", { class: "hint grow" });
  readonly #empty: HTMLElement;
  readonly #root = this.#page.attachShadow({ mode: "open" });
  #report: Report | null = null;
  readonly #endTheme: () => void;

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
  ) {
    const input = h("input", { type: "file", accept: ".html,text/html", class: "visually-hidden", "aria-label": "Report file", onchange: () => {
      const file = input.files?.[0];
      if (file) void this.#open(file);
      input.value = "";
    } });
    const choose = (): HTMLButtonElement => h("button", { onclick: () => input.click() }, icon("upload"), "Open report");
    this.#empty = h("div", { class: "empty" }, icon("report"), h("strong", {}, "No report"), h("p", {}, "navette bench writes a page for every run. Open it here, or drop the file."), choose());
    this.#body = h("div", { class: "body report-body", tabindex: "0", role: "region", "aria-label": "Report" }, this.#page, this.#empty);
    this.#body.addEventListener("dragover", (event) => event.preventDefault());
    this.#body.addEventListener("drop", (event) => {
      event.preventDefault();
      const file = event.dataTransfer?.files[0];
      if (file) void this.#open(file);
    });
    container.append(h("div", { class: "panel" }, this.#bar, input, this.#body));
    this.#bar.append(this.#name, choose());
    this.#bar.hidden = true;
    this.#page.hidden = true;
    this.#root.addEventListener("click", (event) => {
      const command = event.target instanceof HTMLButtonElement ? event.target.previousElementSibling : null;
      if (command?.matches("code")) void this.#copy(command);
    });
    this.#endTheme = context.theme.onChange(() => this.#report?.setDark(context.theme.isDark));
  }

  setVisible(): void {
    // A report does not change.
  }

  dispose = (): void => {
    this.#endTheme();
    this.#root.replaceChildren();
  };

  /** The report's own script does it elsewhere. */
  async #copy(command: Element): Promise<void> {
    try {
      await navigator.clipboard.writeText(command.textContent);
      this.context.announce("Command copied");
    } catch {
      // Other machines' pages, without TLS, have no clipboard.
      getSelection()?.selectAllChildren(command);
      this.context.announce("The browser does not permit copying. The command is selected: press Ctrl+C.");
    }
  }

  async #open(file: File): Promise<void> {
    let report: Report;
    try {
      report = readReport(await file.text());
    } catch (error) {
      this.context.announce(`${file.name}: ${error instanceof Error ? error.message : String(error)}`, "error");
      return;
    }
    this.#report = report;
    report.setDark(this.context.theme.isDark);
    this.#root.adoptedStyleSheets = [report.styles];
    this.#root.replaceChildren(report.content);
    this.#page.hidden = false;
    this.#empty.hidden = true;
    this.#bar.hidden = false;
    this.#name.textContent = report.title;
    this.context.setTitle(report.title);
  }
}

registerPanel({
  id: "report",
  title: "Report",
  icon: "report",
  place: "right",
  hint: "Pages that navette bench wrote.",
  create: (container, context) => new ReportPanel(container, context),
});
