import "./theme/theme.css";
import "./theme/controls.css";
import "./workbench/workbench.css";
import "./workbench/scene.css";
import "./panels/index";
import { App } from "./workbench/app";

void new App().start();
