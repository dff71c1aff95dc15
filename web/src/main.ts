import "./theme/theme.css";
import "./theme/controls.css";
import "./panels/index";
import { Theme } from "./theme/theme";

export const theme = new Theme();
