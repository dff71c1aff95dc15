/** The lines of `/behavior_tree`: py_trees' text with the status of each node. */

export type TreeStatus = "running" | "succeeded" | "failed" | "idle";

export interface TreeLine {
  readonly depth: number;
  readonly status: TreeStatus;
  readonly name: string;
  readonly note: string;
}

const STATUSES: Readonly<Record<string, TreeStatus>> = { "*": "running", "✓": "succeeded", "✕": "failed", "-": "idle" };
const KINDS: Readonly<Record<string, string>> = { "{-}": "sequence", "[-]": "sequence", "{o}": "fallback", "[o]": "fallback", "/_/": "parallel", "-^-": "decorator" };

/** `    {o} Ladder [*] -- note` → depth, status, name and note; null for other text. */
export function treeLine(line: string): TreeLine | null {
  const found = /^( *)(\S+) (.*) \[([*✓✕-])\](?: -- (.*))?$/u.exec(line);
  if (!found) return null;
  const [, indent, sign, name, mark, message] = found;
  const note = [KINDS[sign!], message].filter(Boolean).join(" · ");
  return { depth: indent!.length / 4, status: STATUSES[mark!]!, name: name!, note };
}
