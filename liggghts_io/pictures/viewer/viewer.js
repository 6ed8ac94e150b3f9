// Shows grains as spheres and meshes as glass, turned by mouse or finger. Without WebGL the page
// stays as it is, with its still picture.
(() => {
  const SCENE = document.getElementById("scene");
  const DATA = JSON.parse(document.getElementById("scene-data").textContent);
  const AMBIENT = 0.25; // vtk.js has one light, at the camera
  const NEARER = 1.25; // a scene that is drawn as wide as its place, not as the ball around it

  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const floats = (text) => new Float32Array(bytes(text).buffer);

  function grains() {
    const cloud = vtk.PolyData.newInstance();
    cloud.getPoints().setData(floats(DATA.grains.centres), 3);
    const radii = { name: "radius", values: floats(DATA.grains.radii) };
    const colours = { name: "colour", numberOfComponents: 3, values: bytes(DATA.grains.colours) };
    cloud.getPointData().addArray(vtk.DataArray.newInstance(radii));
    cloud.getPointData().setScalars(vtk.DataArray.newInstance(colours));
    const mapper = vtk.SphereMapper.newInstance();
    mapper.setScaleArray("radius");
    mapper.setInputData(cloud);
    return mapper;
  }

  function surface(mesh) {
    const faces = vtk.PolyData.newInstance();
    const corners = floats(mesh.corners);
    faces.getPoints().setData(corners, 3);
    const cells = new Uint32Array((corners.length / 9) * 4);
    for (let cell = 0; cell < cells.length / 4; cell++) {
      cells.set([3, 3 * cell, 3 * cell + 1, 3 * cell + 2], 4 * cell);
    }
    faces.getPolys().setData(cells);
    const mapper = vtk.Mapper.newInstance();
    mapper.setInputData(faces);
    return mapper;
  }

  function actor(mapper) {
    const made = vtk.Actor.newInstance();
    made.setMapper(mapper);
    made.getProperty().setAmbient(AMBIENT);
    made.getProperty().setDiffuse(1.0 - AMBIENT);
    return made;
  }

  function filled(renderer) {
    renderer.addActor(actor(grains()));
    for (const mesh of DATA.meshes) {
      const made = actor(surface(mesh));
      made.getProperty().setColor(...mesh.colour);
      made.getProperty().setOpacity(mesh.opacity);
      renderer.addActor(made);
    }
  }

  function shown() {
    const place = SCENE.querySelector(".scene-place");
    const renderer = vtk.Renderer.newInstance({ background: [1, 1, 1] });
    const window3d = vtk.RenderWindow.newInstance();
    const canvas = vtk.OpenGLRenderWindow.newInstance();
    const interactor = vtk.Interactor.newInstance();
    window3d.addRenderer(renderer);
    window3d.addView(canvas);
    canvas.setContainer(place);
    interactor.setView(canvas);
    interactor.initialize();
    interactor.setInteractorStyle(vtk.Trackball.newInstance());
    interactor.bindEvents(place);
    filled(renderer);

    function look(name) {
      const { toward, up } = DATA.views[name];
      renderer.getActiveCamera().set({ focalPoint: [0, 0, 0], position: toward, viewUp: up });
      renderer.resetCamera();
      // Its angle is that from bottom to top: in a narrow place the sides would be cut.
      const narrow = Math.min(place.clientWidth / place.clientHeight, 1);
      renderer.getActiveCamera().dolly(NEARER * narrow);
      renderer.resetCameraClippingRange();
      window3d.render();
    }

    new ResizeObserver(() => {
      const scale = window.devicePixelRatio || 1;
      canvas.setSize(
        Math.max(Math.floor(place.clientWidth * scale), 1),
        Math.max(Math.floor(place.clientHeight * scale), 1),
      );
      window3d.render();
    }).observe(place);
    for (const button of SCENE.querySelectorAll("button")) {
      button.addEventListener("click", () => look(button.dataset.view));
    }
    look(DATA.start);
  }

  // A wheel over a scene amid a text moves the text.
  if (!DATA.wheel) {
    SCENE.addEventListener("wheel", (event) => event.ctrlKey || event.stopPropagation(), true);
  }
  if (document.createElement("canvas").getContext("webgl2") === null) {
    return;
  }
  SCENE.hidden = false;
  try {
    shown();
  } catch (error) {
    SCENE.hidden = true;
    throw error;
  }
  for (const still of document.querySelectorAll(".until-scene")) {
    still.hidden = true;
  }
})();
