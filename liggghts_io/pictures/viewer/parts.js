// What viewer.js uses of vtk.js; `npm run build` makes vtk.min.js of it.
import '@kitware/vtk.js/Rendering/OpenGL/Camera.js';
import '@kitware/vtk.js/Rendering/OpenGL/Renderer.js';
import '@kitware/vtk.js/Rendering/OpenGL/Actor.js';
import '@kitware/vtk.js/Rendering/OpenGL/PolyDataMapper.js';
import '@kitware/vtk.js/Rendering/OpenGL/SphereMapper.js';
export { default as Actor } from '@kitware/vtk.js/Rendering/Core/Actor.js';
export { default as DataArray } from '@kitware/vtk.js/Common/Core/DataArray.js';
export { default as Mapper } from '@kitware/vtk.js/Rendering/Core/Mapper.js';
export { default as PolyData } from '@kitware/vtk.js/Common/DataModel/PolyData.js';
export { default as SphereMapper } from '@kitware/vtk.js/Rendering/Core/SphereMapper.js';
export { default as Renderer } from '@kitware/vtk.js/Rendering/Core/Renderer.js';
export { default as RenderWindow } from '@kitware/vtk.js/Rendering/Core/RenderWindow.js';
export { default as Interactor } from '@kitware/vtk.js/Rendering/Core/RenderWindowInteractor.js';
export { default as Trackball } from '@kitware/vtk.js/Interaction/Style/InteractorStyleTrackballCamera.js';
export { default as OpenGLRenderWindow } from '@kitware/vtk.js/Rendering/OpenGL/RenderWindow.js';
