import "./theme/theme.css";
import "./theme/controls.css";
import "./workbench/workbench.css";
import "./workbench/scene.css";
import "./panels/index";
import { keepForOffline } from "./offline/register";
import { App } from "./workbench/app";

const app = new App();
/** For the console and for tests: `navette.scene`, `navette.connection`. */
Object.assign(globalThis, { navette: app });
void app.start();
keepForOffline();
