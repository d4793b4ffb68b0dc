/** Starts the page: tabs, chapters when they are first shown, and `window.armik` for programs. */
(() => {
  const data = JSON.parse(document.getElementById("report-data").textContent);
  const articles = [...document.querySelectorAll(".chapter")];
  const tabs = [...document.querySelectorAll("[role=tab]")];
  const chapters = new Map();
  let active = 0;

  const unpackedScene = (scene) => ({
    ...scene,
    time: unpacked(scene.time),
    path: scene.path && unpacked(scene.path, Float32Array),
    reference: scene.reference && unpacked(scene.reference),
    motions: scene.motions.map((motion, i) =>
      i ? { ...motion, points: unpacked(motion.points, Float32Array) } : { ...motion, q: unpacked(motion.q) }
    ),
  });

  const kinematics = data.kinematics.map((each) => armikKinematics(each));

  async function open(number) {
    const { scene, charts: figures } = data.chapters[number];
    const root = articles[number];
    const chapter = {};
    const charts = new Charts(root, figures, (time, psi) => {
      if (!chapter.player) return;
      chapter.player.pause();
      chapter.player.setTime(time);
      if (psi !== null) chapter.player.swing(radians(psi));
    });
    chapter.charts = charts;
    const arm = await kinematics[scene.kinematics];
    const player = new Player(root.querySelector(".player"), unpackedScene(scene), arm, charts);
    await player.start();
    chapter.player = player;
    await charts.draw();
    player.show();
    return chapter;
  }

  /** Show a chapter; the promise ends when all of it is drawn. */
  function show(number) {
    if (chapters.has(active)) chapters.get(active).then(({ player }) => player.pause());
    active = number;
    articles.forEach((article, i) => (article.hidden = i !== number));
    tabs.forEach((tab, i) => {
      tab.setAttribute("aria-selected", String(i === number));
      tab.tabIndex = i === number ? 0 : -1;
    });
    if (!chapters.has(number)) chapters.set(number, open(number));
    return chapters.get(number);
  }

  tabs.forEach((tab, i) => {
    tab.addEventListener("click", () => show(i));
    tab.addEventListener("keydown", (event) => {
      const moves = { ArrowRight: i + 1, ArrowLeft: i - 1, Home: 0, End: tabs.length - 1 };
      if (!(event.key in moves)) return;
      event.preventDefault();
      const next = (moves[event.key] + tabs.length) % tabs.length;
      show(next);
      tabs[next].focus();
    });
  });

  const fit = async (paper) => {
    if (paper) document.querySelectorAll("details").forEach((each) => (each.open = true));
    (await chapters.get(active)).charts.fit(paper);
  };
  window.addEventListener("beforeprint", () => fit(true));
  window.addEventListener("afterprint", () => fit(false));

  const player = async () => (await chapters.get(active)).player;
  window.armik = Object.freeze({
    ready: () => chapters.get(active).then(() => true),
    show: (number) => show(number).then(() => true),
    fit: (paper) => fit(paper),
    state: async () => ({ chapter: active, ...(await player()).state() }),
    wrist: async () => {
      const { kinematics: arm, posture } = await player();
      return arm.joints(posture)["wrist" in arm.landmarks ? arm.landmarks.wrist : arm.dof];
    },
    setTime: async (time) => (await player()).setTime(time),
    swing: async (psi) => (await player()).swing(psi),
    play: async () => (await player()).play(),
    pause: async () => (await player()).pause(),
  });
  show(0);
})();
