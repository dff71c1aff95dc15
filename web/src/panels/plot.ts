/** Registers the plot; its body comes with uPlot on first use. */

import { registerPanel } from "./panel";

registerPanel({
  id: "plot",
  title: "Plot",
  icon: "plot",
  place: "below",
  isMultiple: true,
  hint: "Any numbers of any messages over time.",
  create: async (container, context) => new (await import("./plot_panel")).PlotPanel(container, context),
});
