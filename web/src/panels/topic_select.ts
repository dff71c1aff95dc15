/** A choice among topics of some types that follows the graph and keeps a topic that is gone. */

import type { Connection, Dispose, Topic } from "../connection/connection";
import { h } from "../ui/dom";

export interface TopicSelect {
  readonly element: HTMLSelectElement;
  readonly value: string;
  choose(topic: string): void;
  dispose: Dispose;
}

export function topicSelect(
  connection: Connection,
  options: {
    label: string;
    value: string;
    none?: string;
    accepts: (topic: Topic) => boolean;
    onChange: (topic: string) => void;
    /** Take the first topic that is accepted while none is chosen. */
    takesFirst?: boolean;
  },
): TopicSelect {
  const element = h("select", { "aria-label": options.label, class: "topic-select" });
  let value = options.value;
  let listed = "";
  const list = (): void => {
    const names = [...connection.topics.values()].filter((topic) => topic.isPublished && options.accepts(topic)).map(({ name }) => name);
    if (!value && options.takesFirst && names[0]) {
      value = names[0];
      options.onChange(value);
    }
    const key = JSON.stringify([names, value]);
    if (key === listed) return;
    listed = key;
    const choices = [new Option(options.none ?? "Choose a topic", "", false, value === "")];
    for (const name of names) choices.push(new Option(name, name, false, name === value));
    if (value && !names.includes(value)) choices.push(new Option(`${value} (not published)`, value, false, true));
    element.replaceChildren(...choices);
    element.hidden = options.none !== undefined && names.length === 0 && !value;
    element.value = value;
  };
  element.addEventListener("change", () => {
    value = element.value;
    listed = "";
    options.onChange(value);
    list();
  });
  const off = connection.on("topics", list);
  list();
  return {
    element,
    get value() {
      return value;
    },
    choose(topic) {
      value = topic;
      listed = "";
      list();
      options.onChange(topic);
    },
    dispose: off,
  };
}
