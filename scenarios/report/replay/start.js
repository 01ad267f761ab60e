// SPDX-License-Identifier: Apache-2.0
"use strict";

(async () => {
  const root = document.getElementById("app");
  try {
    const app = new Plumb.App(await Plumb.data.load());
    Plumb.app = app;
    await app.start(root);
  } catch (error) {
    document.body.dataset.error = String(error.message || error);
    root.append(Plumb.make("p", { class: "note bad" }, "The page cannot be shown: " + (error.message || error)));
  }
})();
